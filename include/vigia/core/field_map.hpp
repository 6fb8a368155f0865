#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/config.hpp"

namespace vigia {

/// A painted line of a field, by its centre line: a straight piece from a to b, or an arc. World
/// frame, metres, radians.
struct FieldLine {
  enum class Kind { segment, arc };
  Kind kind = Kind::segment;
  double width_m = 0.125;
  Eigen::Vector2d a = Eigen::Vector2d::Zero();  ///< segment: from
  Eigen::Vector2d b = Eigen::Vector2d::Zero();  ///< segment: to
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
  double from = 0.0;   ///< arc: angle of its beginning
  double sweep = 0.0;  ///< arc: in (0, 2π], counter-clockwise; 2π is a circle without ends

  static FieldLine segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width_m);
  static FieldLine arc(const Eigen::Vector2d& centre, double radius_m, double from, double sweep,
                       double width_m);
  double length_m() const;
  /// The point at arc length @p s from the line's beginning.
  Eigen::Vector2d at(double s) const;
  bool closed() const;
};

/// Where a point lies beside a line's centre line, carried on straight (or round) beyond its ends.
struct LineOffset {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< unit; ∂distance/∂p
  double distance_m = 0.0;                            ///< signed, along the normal
  double inside_m = 0.0;  ///< along the line to its nearer end, negative beyond; +∞ for a circle
};

LineOffset line_offset(const FieldLine& line, const Eigen::Vector2d& p);
/// Distance from a point to a line's centre line, its ends included.
double distance_to_line(const FieldLine& line, const Eigen::Vector2d& p);

/// Ranges in (0, max_m] at which a ray crosses a line's centre line, and the line's normal there.
struct LineCrossing {
  double range_m = 0.0;
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
};
void cross_line(const FieldLine& line, const Eigen::Vector2d& origin,
                const Eigen::Vector2d& direction, double max_m, std::vector<LineCrossing>& out);

enum class FieldColour { white, yellow, blue };
std::string_view to_string(FieldColour colour);

/// A goal: its mouth from one post to the other, and its back depth_m behind.
struct FieldGoal {
  FieldColour colour = FieldColour::white;
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double depth_m = 0.5;
  double height_m = 1.0;
  double frame_m = 0.125;  ///< width of its white posts and bar; 0: it has none
  Eigen::Vector2d centre() const { return 0.5 * (from + to); }
};

/// A corner post banded in yellow and blue; the colour is that of its outer bands.
struct CornerPost {
  FieldColour outer = FieldColour::yellow;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius_m = 0.1;
  double height_m = 1.0;
};

/// A field of play as the robot knows it: what is painted on its floor and what stands on it.
/// The origin is the centre, x along its length.
struct FieldMap {
  double length_m = 12.0;  ///< between the goal lines
  double width_m = 8.0;    ///< between the touch lines
  double margin_m = 1.0;   ///< of floor round about
  std::vector<FieldLine> lines;
  std::vector<FieldGoal> goals;
  std::vector<CornerPost> posts;

  /// Whether the field looks the same after half a turn about its centre: then nothing on it tells
  /// its halves apart. @p with_goals false: whether its lines do.
  bool half_turn_symmetric(bool with_goals = true) const;
  /// Whether @p p lies between goal and touch lines, or off them by at most @p beyond_m.
  bool contains(const Eigen::Vector2d& p, double beyond_m = 0.0) const;
  const FieldGoal* goal(FieldColour colour) const;
};

/// Reads the block `field`: length_m, width_m, margin_m, line_width_m, lines, arcs, goals,
/// posts. Throws InputError.
FieldMap read_field_map(MapReader reader);

/// Which lines can lie near a point: a grid whose cells list the lines within reach, and the
/// distance from the cell's centre to the nearest. Exact distances are then computed from the few.
class FieldDistance {
 public:
  /// @p reach_m: lines farther from a point than this are not listed for it.
  FieldDistance(const FieldMap& map, double reach_m = 0.6, double cell_m = 0.1);

  struct Candidates {
    const std::uint16_t* first;
    const std::uint16_t* last;
    const std::uint16_t* begin() const { return first; }
    const std::uint16_t* end() const { return last; }
  };
  /// Indices into lines() of every line within reach of @p p (and perhaps a few more); none outside
  /// the grid.
  Candidates near(const Eigen::Vector2d& p) const;
  /// Exact distance to the nearest line, at most reach_m.
  double distance(const Eigen::Vector2d& p) const;
  double reach_m() const { return reach_m_; }
  const std::vector<FieldLine>& lines() const { return lines_; }

 private:
  std::vector<FieldLine> lines_;
  double reach_m_;
  double cell_m_;
  Eigen::Vector2d corner_;  ///< lower left, world
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> first_;  ///< per cell, into candidates_; one more at the end
  std::vector<std::uint16_t> candidates_;
};

}  // namespace vigia
