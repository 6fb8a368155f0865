#include "vigia/core/ceiling_grid.hpp"

#include <cmath>

namespace vigia {

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
