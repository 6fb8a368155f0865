#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/pose.hpp"

namespace vigia {

class ParamVisitor;

/// Patches of one colour and shape on a ceiling, one at every node of a square grid: a rule, not a
/// list, so that a hall of any size takes the same memory. Patches have no identity. Seen from
/// below, a patch is a strip whose long axis points along the grid's x; one with a polarity mark
/// has its forward end drawn in to a tongue, one without looks the same after half a turn.
struct CeilingGrid {
  double height_m = 2.7;   ///< of the ceiling above the ground
  double pitch_m = 1.0;    ///< between neighbouring patches
  double length_m = 0.09;  ///< of a patch, tongue and all
  double width_m = 0.03;
  bool polarity = true;
  double placement_m = 0.0;     ///< σ of a patch's place in x and in y
  double placement_turn = 0.0;  ///< σ of its direction, rad
  /// A rectangle of the ceiling, world frame, metres.
  struct Extent {
    Eigen::Vector2d min = Eigen::Vector2d::Zero();
    Eigen::Vector2d max = Eigen::Vector2d::Zero();
  };
  std::optional<Extent> extent;  ///< where patches hang at all; nothing: everywhere
  /// Where none hangs, and the map says so: skylights, a stairwell, a gallery. A patch is missing
  /// where its middle would lie in one.
  std::vector<Extent> gaps;
};

/// A node of the grid: column and row.
struct CeilingCell {
  std::int64_t i = 0;
  std::int64_t j = 0;
};

constexpr bool operator==(const CeilingCell& a, const CeilingCell& b) {
  return a.i == b.i && a.j == b.j;
}
constexpr bool operator!=(const CeilingCell& a, const CeilingCell& b) {
  return !(a == b);
}
constexpr bool operator<(const CeilingCell& a, const CeilingCell& b) {
  return a.i != b.i ? a.i < b.i : a.j < b.j;
}

/// A patch's tongue as shares of its length and width; the body is what lies behind it.
inline constexpr double kTongueLength = 1.0 / 6.0;
inline constexpr double kTongueWidth = 1.0 / 3.0;

/// The keys of a world file's `ceiling`; the height is the room's.
void describe(ParamVisitor& v, CeilingGrid& grid);

/// Where the middle of a cell's patch should hang, world frame.
Eigen::Vector2d cell_centre(const CeilingGrid& grid, const CeilingCell& cell);
/// The cell whose centre is nearest.
CeilingCell nearest_cell(const CeilingGrid& grid, const Eigen::Vector2d& p);
/// The cells whose patches lie in a rectangle; as many as the pitch goes into it, whatever its
/// corners' last digits.
struct CeilingCells {
  CeilingCell first;
  CeilingCell last;
  bool contains(const CeilingCell& cell) const {
    return cell.i >= first.i && cell.j >= first.j && cell.i <= last.i && cell.j <= last.j;
  }
  /// Of columns and rows; none where the last lies before the first.
  std::int64_t count() const;
};
CeilingCells cells_in(const CeilingGrid& grid, const CeilingGrid::Extent& rectangle);

/// Whether the grid goes on for ever without a gap, so that nothing tells its cells apart.
bool is_endless(const CeilingGrid& grid);
/// Whether the grid has a patch there.
bool has_patch(const CeilingGrid& grid, const CeilingCell& cell);

}  // namespace vigia
