#pragma once

#include <Eigen/Core>

namespace vigia {

/// How a camera that faces a plane moved between two frames, by the picture alone. In units of its
/// distance to the plane: what was seen in the direction m = (x, y) of the first frame, levelled,
/// is seen in R(turn)ᵀ (m − shift) of the second.
struct ImageShift {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  double turn = 0.0;                                         ///< rad
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (shift, turn)
};

}  // namespace vigia
