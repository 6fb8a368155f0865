#pragma once

#include <vector>

#include "vigia/core/observation.hpp"
#include "vigia/localization/points_model.hpp"

namespace vigia::localization {

/// One of the poses in which a disc looks as it was seen.
struct DiscPose {
  Eigen::Isometry3d cMl = Eigen::Isometry3d::Identity();
  /// Of δ = (v, ω), see moved(). A disc does not tell how it is turned about its own normal: that
  /// part of ω has the variance of an angle that is uniform over a turn. Tilt is given no more.
  PoseMatrix covariance = PoseMatrix::Zero();
  double misfit_px = 0.0;  ///< of the ellipse that this pose predicts
};

/// The poses of a disc of @p radius_m whose image is @p ellipse with the covariance of (u, v, a, b,
/// psi): the cone of the ellipse cut by the two planes in which it is a circle (Chen, Wu & Wada,
/// ECCV 2004), then Gauss–Newton on the exact image through the lens. Two poses, mirrored in the
/// line of sight; seen frontally they are one. The first is the one that fits better, as a rule by
/// nothing. None when the ellipse is no disc's in front of the camera.
std::vector<DiscPose> disc_poses(const Ellipse& ellipse,
                                 const Eigen::Matrix<double, 5, 5>& covariance, double radius_m,
                                 const Intrinsics& intrinsics);

}  // namespace vigia::localization
