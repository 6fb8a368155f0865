#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/camera.hpp"
#include "vigia/localization/points_model.hpp"

namespace vigia::evaluation {

/// Adán's φ, θ and D of a camera position in frame l, and their derivatives by it: spherical
/// coordinates about the pattern's normal.
struct SphericalView {
  Eigen::Vector3d phi_theta_distance;
  Eigen::Matrix3d by_position_l;
};
SphericalView spherical_view(const Eigen::Vector3d& p_l);

/// Cramér–Rao bounds of one view: no unbiased estimator that sees these points, each with its own
/// noise, has a smaller covariance. All six degrees of freedom of the pose are unknown.
struct ViewBound {
  Eigen::Matrix3d phi_theta_distance;  ///< covariance of (φ, θ, D), rad and m
  Eigen::Matrix3d position_l;          ///< of the camera's position in the landmark's frame, m²
};

/// By the Jacobian of the exact images of all points (their covariances count, not their pixels).
/// Nothing when a point has no image or the points do not fix the pose.
std::optional<ViewBound> view_bound(const std::vector<localization::SeenPoint>& points,
                                    const Intrinsics& intrinsics, const Eigen::Isometry3d& cMl);

}  // namespace vigia::evaluation
