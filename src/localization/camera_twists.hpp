#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/head.hpp"

namespace vigia::localization {

/// Columns: the camera's twist (v, ω) in its own frame per x, y, θ, pan and tilt.
inline Eigen::Matrix<double, 6, 5> camera_twists(const HeadGeometry& geometry,
                                                 const HeadAngles& head,
                                                 const Eigen::Isometry3d& wMc) {
  Eigen::Matrix<double, 6, 5> twists = Eigen::Matrix<double, 6, 5>::Zero();
  twists.topLeftCorner<3, 2>() = wMc.linear().transpose().leftCols<2>();
  twists.col(2) = camera_jacobian_base(geometry, head).col(1);
  twists.rightCols<2>() = camera_jacobian_head(geometry, head);
  return twists;
}

}  // namespace vigia::localization
