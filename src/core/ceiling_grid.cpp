#include "vigia/core/ceiling_grid.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/params.hpp"

namespace vigia {
namespace {

void describe_rectangle(ParamVisitor& v, CeilingGrid::Extent& rectangle, const char* begin,
                        const char* end, const char* message) {
  v.vector("min_m", rectangle.min, {-1e4, 1e4}, About(begin).required());
  v.vector("max_m", rectangle.max, {-1e4, 1e4}, About(end).required());
  v.require(v.reader() == nullptr || (rectangle.min.array() <= rectangle.max.array()).all(),
            "max_m", message);
}

void describe_gap(ParamVisitor& v, CeilingGrid& grid) {
  CeilingGrid::Extent gap;
  describe_rectangle(v, gap, "corner of the gap with the lesser x and y", "the opposite one",
                     "the gap ends before it begins");
  if (v.reader() == nullptr) return;
  v.require(cells_in(grid, gap).count() > 0, "max_m",
            "no patch's place lies in this gap: they are at the multiples of pitch_m");
  if (grid.extent) {
    const CeilingGrid::Extent common{gap.min.cwiseMax(grid.extent->min),
                                     gap.max.cwiseMin(grid.extent->max)};
    v.require(cells_in(grid, common).count() > 0, "max_m",
              "the gap lies outside of the grid, which ends at min_m and max_m of the ceiling");
    v.require(cells_in(grid, common).count() < cells_in(grid, *grid.extent).count(), "max_m",
              "the gap leaves no patch of the grid");
  }
  grid.gaps.push_back(gap);
}

}  // namespace

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
  const bool ends = v.given("min_m", [&] {
    grid.extent = CeilingGrid::Extent{};
    describe_rectangle(v, *grid.extent, "where patches begin", "where they end",
                       "the grid ends before it begins");
    v.require(v.reader() == nullptr || cells_in(grid, *grid.extent).count() > 0, "max_m",
              "no patch hangs in this grid: they are at the multiples of pitch_m");
  });
  v.require(ends || v.reader() == nullptr || !v.reader()->has("max_m"), "max_m",
            "the grid ends and does not begin: min_m is missing beside it");
  v.each("gaps", "rectangles in which no patch hangs", [&] { describe_gap(v, grid); });
}

Eigen::Vector2d cell_centre(const CeilingGrid& grid, const CeilingCell& cell) {
  return {grid.pitch_m * static_cast<double>(cell.i), grid.pitch_m * static_cast<double>(cell.j)};
}

CeilingCell nearest_cell(const CeilingGrid& grid, const Eigen::Vector2d& p) {
  return {std::llround(p.x() / grid.pitch_m), std::llround(p.y() / grid.pitch_m)};
}

std::int64_t CeilingCells::count() const {
  return std::max<std::int64_t>(0, last.i - first.i + 1) *
         std::max<std::int64_t>(0, last.j - first.j + 1);
}

CeilingCells cells_in(const CeilingGrid& grid, const CeilingGrid::Extent& rectangle) {
  constexpr double kRounding = 1e-6;  // of the pitch
  const Eigen::Array2d from = (rectangle.min.array() / grid.pitch_m - kRounding).ceil();
  const Eigen::Array2d to = (rectangle.max.array() / grid.pitch_m + kRounding).floor();
  return {{static_cast<std::int64_t>(from.x()), static_cast<std::int64_t>(from.y())},
          {static_cast<std::int64_t>(to.x()), static_cast<std::int64_t>(to.y())}};
}

bool is_endless(const CeilingGrid& grid) {
  return !grid.extent && grid.gaps.empty();
}

bool has_patch(const CeilingGrid& grid, const CeilingCell& cell) {
  if (grid.extent && !cells_in(grid, *grid.extent).contains(cell)) return false;
  return std::none_of(grid.gaps.begin(), grid.gaps.end(), [&](const CeilingGrid::Extent& gap) {
    return cells_in(grid, gap).contains(cell);
  });
}

}  // namespace vigia
