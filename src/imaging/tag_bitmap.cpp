#include "vigia/imaging/tag_bitmap.hpp"

#include <memory>
#include <stdexcept>
#include <string>

extern "C" {
#include <apriltag.h>
#include <tag36h11.h>
}

namespace vigia::imaging {

TagBitmap tag_bitmap(int tag) {
  const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family(tag36h11_create(),
                                                                               &tag36h11_destroy);
  if (tag < 0 || tag >= static_cast<int>(family->ncodes))
    throw std::invalid_argument("tag " + std::to_string(tag) + " is not in 0–" +
                                std::to_string(family->ncodes - 1));
  TagBitmap black{};
  for (auto& row : black) row.fill(true);
  // Bit 0 of the table is the code's most significant one; x and y count from the border's corner.
  for (unsigned bit = 0; bit < family->nbits; ++bit) {
    const bool white = (family->codes[tag] >> (family->nbits - 1 - bit) & 1U) != 0;
    black.at(family->bit_y[bit]).at(family->bit_x[bit]) = !white;
  }
  return black;
}

}  // namespace vigia::imaging
