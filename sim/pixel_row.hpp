#pragma once

#include "rays.hpp"
#include "surface.hpp"

#include <vector>

namespace vigia::sim {

/// Neighbouring pixels of one row, on their way from rays to grey levels.
struct PixelRow {
  explicit PixelRow(int count, bool perspective)
      : x(static_cast<std::size_t>(count)),
        y(x),
        z(perspective ? std::vector<float>{} : x),
        grey(x),
        other(x),
        depth(x),
        winner(x.size()),
        hit(x.size()) {}

  Rays rays() const { return {x.data(), y.data(), z.empty() ? nullptr : z.data()}; }

  std::vector<float> x, y, z;
  std::vector<float> grey;
  std::vector<float> other;        ///< of one surface or decal
  std::vector<float> depth;        ///< inverse, of what is seen
  std::vector<float> paint;        ///< share of a field's lines; empty without a field
  std::vector<ViewId> winner;      ///< the surface that is seen
  std::vector<unsigned char> hit;  ///< 1 where a limb is seen
};

}  // namespace vigia::sim
