#pragma once

#include <optional>

#include <Eigen/Core>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia {

/// A sector of the plane with its tip in the origin, narrower than a half-plane: what a sensor with
/// a cone for a beam sees.
struct Sector {
  Eigen::Vector2d right;  ///< unit vectors along the edges
  Eigen::Vector2d left;

  /// Opens by @p half_angle (rad) to either side of @p direction.
  static Sector about(double direction, double half_angle) {
    return {unit_vector(direction - half_angle), unit_vector(direction + half_angle)};
  }
  bool holds(const Eigen::Vector2d& p) const {
    return cross(right, p) >= 0.0 && cross(left, p) <= 0.0;
  }
};

/// Cuts [@p low, @p high], fractions of the way along a segment, down to where a linear function is
/// not negative that is @p at_a at its beginning and @p at_b at its end. False: nothing is left.
bool keep_positive(double at_a, double at_b, double& low, double& high);

/// Distance from the tip to the nearest point of the plan's faces higher than @p above_m in the
/// sector with its tip at @p p, or nothing within @p reach_m. What lies nearest in it is never
/// hidden, so no ray needs casting.
std::optional<double> nearest_face(const FloorPlan& plan, const Eigen::Vector2d& p,
                                   const Sector& sector, double reach_m, double above_m);

}  // namespace vigia
