#pragma once

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace vigia {

/// z component of the cross product of two vectors of the plane.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The unit vector at @p angle from x towards y, radians.
inline Eigen::Vector2d unit_vector(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// Where two segments cross: fractions of the way along each.
struct Crossing {
  double along_pq = 0.0;
  double along_ab = 0.0;
};

/// Distance from a point to the segment from @p a to @p b.
double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b);

/// The crossing of the lines pq and ab, wherever it lies; nothing when they are parallel.
std::optional<Crossing> cross_lines(const Eigen::Vector2d& p, const Eigen::Vector2d& q,
                                    const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// Whether the segments pq and ab have a point in common (touching and overlapping count).
bool segments_meet(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& a,
                   const Eigen::Vector2d& b);

/// Whether a point lies inside a polygon of either orientation (even-odd rule).
bool inside_polygon(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& polygon);

/// Area of a simple polygon of either orientation.
double polygon_area(const std::vector<Eigen::Vector2d>& polygon);

/// Distance from a point to the outline of a polygon.
double distance_to_outline(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& polygon);

/// Indices of two sides that meet elsewhere than in a shared corner, if any do.
std::optional<std::pair<std::size_t, std::size_t>> crossing_sides(
    const std::vector<Eigen::Vector2d>& polygon);

}  // namespace vigia
