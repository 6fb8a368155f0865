#include "room_to_move.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::planner {
namespace {

using Eigen::Vector2d;

bool cross_each_other(const Vector2d& a0, const Vector2d& a1, const Vector2d& b0,
                      const Vector2d& b1) {
  const Vector2d a = a1 - a0;
  const Vector2d b = b1 - b0;
  return cross(a, b0 - a0) * cross(a, b1 - a0) < 0.0 && cross(b, a0 - b0) * cross(b, a1 - b0) < 0.0;
}

/// Whether the boxes around two segments are farther apart than @p distance.
bool boxes_apart(const Vector2d& a0, const Vector2d& a1, const Vector2d& b0, const Vector2d& b1,
                 double distance) {
  return (a0.cwiseMin(a1).array() > b0.cwiseMax(b1).array() + distance).any() ||
         (b0.cwiseMin(b1).array() > a0.cwiseMax(a1).array() + distance).any();
}

}  // namespace

double segment_distance(const Vector2d& a0, const Vector2d& a1, const Vector2d& b0,
                        const Vector2d& b1) {
  if (cross_each_other(a0, a1, b0, b1)) return 0.0;
  return std::min({distance_to_segment(a0, b0, b1), distance_to_segment(a1, b0, b1),
                   distance_to_segment(b0, a0, a1), distance_to_segment(b1, a0, a1)});
}

double RoomToMove::clearance(const Vector2d& p) const {
  double nearest = plan_->clearance(p);
  for (const RoundObstacle& other : others_)
    nearest = std::min(nearest, (p - other.centre).norm() - other.radius_m);
  return nearest;
}

bool RoomToMove::passes(const Vector2d& a, const Vector2d& b) const {
  const auto& faces = plan_->faces();
  return std::all_of(faces.begin(), faces.end(),
                     [&](const Wall& face) {
                       return boxes_apart(a, b, face.a, face.b, radius_m_) ||
                              segment_distance(a, b, face.a, face.b) >= radius_m_;
                     }) &&
         std::all_of(others_.begin(), others_.end(), [&](const RoundObstacle& other) {
           return distance_to_segment(other.centre, a, b) >= radius_m_ + other.radius_m;
         });
}

std::optional<Vector2d> RoomToMove::retreat(const Vector2d& p) const {
  constexpr double kRingSpacing = 0.05;
  constexpr int kRings = 20;
  constexpr int kDirections = 32;
  const double here = clearance(p);
  if (here >= radius_m_) return p;
  // Rounding must not let the place itself fail.
  const RoomToMove smaller(*plan_, here - 1e-9, others_);
  for (int ring = 1; ring <= kRings; ++ring) {
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2.0 * kPi * k / kDirections;
      const Vector2d q = p + ring * kRingSpacing * unit_vector(angle);
      if (fits(q) && smaller.passes(p, q)) return q;
    }
  }
  return std::nullopt;
}

}  // namespace vigia::planner
