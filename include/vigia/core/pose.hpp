#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/angle.hpp"

namespace vigia {

/// A planar pose wMr: the frame r seen from w (metres, radians, z up, θ counter-clockwise from x).
struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double theta = 0.0;

  Eigen::Vector2d position() const { return {x, y}; }
  Eigen::Vector3d vector() const { return {x, y, theta}; }
  static Pose2 from_vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), wrap_angle(v.z())}; }
};

/// aMc from aMb and bMc.
Pose2 compose(const Pose2& aMb, const Pose2& bMc);
/// bMa from aMb.
Pose2 inverse(const Pose2& aMb);
/// @p a − @p b component by component, the angle wrapped.
Eigen::Vector3d difference(const Pose2& a, const Pose2& b);
/// The planar pose as a rigid transform at height @p z.
Eigen::Isometry3d to_isometry(const Pose2& pose, double z = 0.0);

}  // namespace vigia
