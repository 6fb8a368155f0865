#pragma once

#include <Eigen/Core>

namespace vigia::localization {

/// Below this cosine between its normal and the line of sight a landmark is edge on.
inline constexpr double kEdgeOn = 1e-3;

/// [v]×: skew(v) · u = v × u.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

}  // namespace vigia::localization
