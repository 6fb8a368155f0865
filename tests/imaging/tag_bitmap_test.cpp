#include "vigia/imaging/tag_bitmap.hpp"

#include <memory>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

extern "C" {
#include <apriltag.h>
#include <common/image_u8.h>
#include <tag36h11.h>
}

namespace vigia::imaging {
namespace {

TEST(TagBitmap, EqualsThePictureThatTheLibraryDraws) {
  const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family(tag36h11_create(),
                                                                               &tag36h11_destroy);
  for (const int tag : {0, 1, 17, 300, 586}) {
    const std::unique_ptr<image_u8_t, decltype(&image_u8_destroy)> picture(
        apriltag_to_image(family.get(), static_cast<uint32_t>(tag)), &image_u8_destroy);
    const int rim = (family->total_width - kTagFields) / 2;
    const TagBitmap black = tag_bitmap(tag);
    for (int row = 0; row < kTagFields; ++row)
      for (int column = 0; column < kTagFields; ++column)
        EXPECT_EQ(black.at(static_cast<std::size_t>(row)).at(static_cast<std::size_t>(column)),
                  picture->buf[(row + rim) * picture->stride + column + rim] < 128)
            << "tag " << tag << ", row " << row << ", column " << column;
  }
}

TEST(TagBitmap, IsAnotherForEachTagAndNothingBeyondTheFamily) {
  std::set<TagBitmap> pictures;
  for (int tag = 0; tag < 587; tag += 1) pictures.insert(tag_bitmap(tag));
  EXPECT_EQ(pictures.size(), 587U);
  EXPECT_THROW(tag_bitmap(587), std::invalid_argument);
  EXPECT_THROW(tag_bitmap(-1), std::invalid_argument);
}

}  // namespace
}  // namespace vigia::imaging
