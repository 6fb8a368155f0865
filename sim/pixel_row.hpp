#pragma once

#include "pixel_piece.hpp"
#include "rays.hpp"
#include "surface.hpp"

#include <cstdint>
#include <vector>

namespace vigia::sim {

/// Pixels that are computed together, on their way from rays to grey levels: neighbours in one row
/// of a perspective picture, any pieces of one tile of another.
struct PixelRow {
  PixelRow(int most, bool perspective)
      : x(static_cast<std::size_t>(most)),
        y(x),
        z(perspective ? std::vector<float>{} : x),
        u(z.size()),
        v(z.size()),
        grey(x),
        other(x),
        depth(x),
        winner(x.size()),
        hit(x.size()) {}

  Rays rays() const { return {x.data(), y.data(), z.empty() ? nullptr : z.data()}; }

  /// Takes the pixels of @p these, no more than there is room for.
  void take(const Pieces& these) {
    pieces = these;
    count = 0;
    for (const Piece& piece : pieces) {
      if (!u.empty()) {
        for (int i = 0; i < piece.count; ++i) {
          const int at = count + i;
          u[static_cast<std::size_t>(at)] = piece.u + i;
          v[static_cast<std::size_t>(at)] = piece.v;
        }
      }
      count += piece.count;
    }
  }

  Pieces pieces;
  int count = 0;
  std::vector<float> x, y, z;
  std::vector<std::int32_t> u, v;  ///< of a picture that is not perspective
  std::vector<float> grey;
  std::vector<float> other;        ///< of one surface or decal
  std::vector<float> depth;        ///< inverse, of what is seen
  std::vector<float> paint;        ///< share of a field's lines; empty without a field
  std::vector<ViewId> winner;      ///< the surface that is seen
  std::vector<unsigned char> hit;  ///< 1 where a limb is seen
};

}  // namespace vigia::sim
