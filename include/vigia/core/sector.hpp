#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia {

/// @p v turned by the angle of the unit vector @p by.
inline Eigen::Vector2d turned(const Eigen::Vector2d& v, const Eigen::Vector2d& by) {
  return {by.x() * v.x() - by.y() * v.y(), by.y() * v.x() + by.x() * v.y()};
}

/// A sector of the plane with its tip in the origin, narrower than a half-plane: what a sensor with
/// a cone for a beam sees.
struct Sector {
  Eigen::Vector2d right;  ///< unit vectors along the edges
  Eigen::Vector2d left;

  /// Opens by @p half_angle (rad) to either side of @p direction.
  static Sector about(double direction, double half_angle) {
    return {unit_vector(direction - half_angle), unit_vector(direction + half_angle)};
  }
  Sector turned(const Eigen::Vector2d& by) const {
    return {vigia::turned(right, by), vigia::turned(left, by)};
  }
  bool holds(const Eigen::Vector2d& p) const {
    return cross(right, p) >= 0.0 && cross(left, p) <= 0.0;
  }
};

/// Cuts [@p low, @p high], fractions of the way along a segment, down to where a linear function is
/// not negative that is @p at_a at its beginning and @p at_b at its end. False: nothing is left.
bool keep_positive(double at_a, double at_b, double& low, double& high);

/// The faces of a plan higher than @p above_m within @p reach_m of a point: for many sectors and
/// rays from there.
class NearFaces {
 public:
  /// @p plan outlives it.
  NearFaces(const FloorPlan& plan, const Eigen::Vector2d& origin, double reach_m, double above_m);

  /// Distance from the origin to the nearest point in the sector with its tip there, or nothing
  /// within reach. What lies nearest in it is never hidden, so no ray needs casting.
  std::optional<double> nearest_in(const Sector& sector) const;
  /// As FloorPlan::cast(), but for the place along the face.
  std::optional<RayHit> cast(const Eigen::Vector2d& direction, double max_m) const;

 private:
  struct Side {
    const Wall* face;
    Eigen::Vector2d a, b;  ///< from the origin
  };
  const FloorPlan* plan_;
  Eigen::Vector2d origin_;
  double reach_m_;
  std::vector<Side> sides_;
};

/// NearFaces::nearest_in() of a single sector.
std::optional<double> nearest_face(const FloorPlan& plan, const Eigen::Vector2d& p,
                                   const Sector& sector, double reach_m, double above_m);

}  // namespace vigia
