#include "vigia/core/ceiling_grid.hpp"

#include <cmath>

#include "vigia/core/params.hpp"

namespace vigia {

void describe(ParamVisitor& v, CeilingGrid& grid) {
  v.number("pitch_m", grid.pitch_m, {0.2, 20.0}, "between neighbouring patches");
  v.number("length_m", grid.length_m, {0.02, 1.0}, "of a patch, along the grid's x");
  v.number("width_m", grid.width_m, {0.01, 0.5}, "of a patch");
  v.require(v.reader() == nullptr || grid.width_m <= 0.6 * grid.length_m, "width_m",
            "a patch must be longer than wide (width_m at most 0.6 length_m) to have a direction");
  v.require(v.reader() == nullptr || grid.length_m <= 0.4 * grid.pitch_m, "length_m",
            "patches must lie apart: length_m is at most 0.4 pitch_m");
  v.boolean(
      "polarity", grid.polarity,
      "whether a patch's forward end is marked; without, it looks the same after half a turn");
  v.number("placement_m", grid.placement_m, {0.0, 0.1}, "σ of a patch's true place, in x and in y");
  v.angle("placement_deg", grid.placement_turn, {0.0, 20.0}, "σ of a patch's true direction");
  v.given("min_m", [&] {
    auto& extent = grid.extent.emplace();
    v.vector("min_m", extent.min, {-1e4, 1e4}, About("where patches begin").required());
    v.vector("max_m", extent.max, {-1e4, 1e4}, About("where they end").required());
    v.require(v.reader() == nullptr || (extent.min.array() <= extent.max.array()).all(), "max_m",
              "the grid ends before it begins");
  });
}

Eigen::Vector2d cell_centre(const CeilingGrid& grid, const CeilingCell& cell) {
  return {grid.pitch_m * static_cast<double>(cell.i), grid.pitch_m * static_cast<double>(cell.j)};
}

CeilingCell nearest_cell(const CeilingGrid& grid, const Eigen::Vector2d& p) {
  return {std::llround(p.x() / grid.pitch_m), std::llround(p.y() / grid.pitch_m)};
}

bool has_patch(const CeilingGrid& grid, const CeilingCell& cell) {
  if (!grid.extent) return true;
  const Eigen::Array2d p = cell_centre(grid, cell).array();
  return (p >= grid.extent->min.array()).all() && (p <= grid.extent->max.array()).all();
}

}  // namespace vigia
