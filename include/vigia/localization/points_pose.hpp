#pragma once

#include <optional>
#include <vector>

#include "vigia/localization/points_model.hpp"

namespace vigia::localization {

struct PointsPoseParams {
  int iterations = 60;      ///< Levenberg–Marquardt steps, at most
  double converged = 1e-9;  ///< a step that moves less (m, rad) is the last
  /// The twin is as good unless so many times less likely.
  double ambiguity_ratio = 20.0;
  double frontal_below = 0.4363323129985824;  ///< φ under which a view counts as frontal: 25°
};

/// A pose and how well it explains the points.
struct FittedPose {
  Eigen::Isometry3d cMl = Eigen::Isometry3d::Identity();
  PoseMatrix covariance = PoseMatrix::Zero();  ///< of δ = (v, ω), see moved()
  /// ∂δ/∂ln f: how the estimate moves with an error of the focal length.
  PoseVector dpose_dlog_focal = PoseVector::Zero();
  double chi2 = 0.0;
  int dof = 0;  ///< 2 × points − 6
  int iterations = 0;
};

enum class PointsPoseStatus {
  solved,
  ambiguous,   ///< solved, and the twin explains the points about as well
  too_few,     ///< fewer than four usable points
  degenerate,  ///< the points lie on a line, or nowhere in front of the camera
  not_converged,
};

struct PointsPose {
  PointsPoseStatus status = PointsPoseStatus::too_few;
  FittedPose pose;
  /// The other minimum, mirrored in the line of sight, where there is one.
  std::optional<FittedPose> twin;
  double phi = 0.0;      ///< between the normal and the line of sight, rad
  bool frontal = false;  ///< φ is small: orientation, and with it the position, is poor

  bool has_pose() const {
    return status == PointsPoseStatus::solved || status == PointsPoseStatus::ambiguous;
  }
};

/// The pose of a planar landmark that explains its points best: homography (direct linear
/// transform) for a start, then Levenberg–Marquardt on the exact images of all points, once from
/// the start and once from its twin. The better minimum is the pose, the other one the twin.
PointsPose solve_points(const std::vector<SeenPoint>& points, const Intrinsics& intrinsics,
                        const PointsPoseParams& params = {});

/// Levenberg–Marquardt from @p start. Nothing when a point has no image from there or the steps do
/// not converge.
std::optional<FittedPose> refine_pose(const std::vector<SeenPoint>& points,
                                      const Intrinsics& intrinsics, const Eigen::Isometry3d& start,
                                      const PointsPoseParams& params = {});

}  // namespace vigia::localization
