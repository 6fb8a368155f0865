#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/camera.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/localization/disc_model.hpp"

namespace vigia::localization {

/// A point of a landmark that is known by its label: a pattern's dot, or a tag's corner (radius 0).
struct LandmarkPoint {
  int label = 0;
  Eigen::Vector2d centre_l = Eigen::Vector2d::Zero();  ///< (x, y) in the landmark's plane, m
  double radius_m = 0.0;
};

/// The labelled points of a landmark in the order of their labels: 17 dots of a pattern, 4 corners
/// of a tag, none of a disc.
std::vector<LandmarkPoint> landmark_points(const Landmark& landmark);

/// A point and where it was seen.
struct SeenPoint {
  LandmarkPoint point;
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity();  ///< inverse covariance, px⁻²
};

/// The usable points of an observation: those with a label of the landmark, finite pixels and a
/// positive definite covariance, to which @p floor_px² is added on the diagonal.
std::vector<SeenPoint> seen_points(const Landmark& landmark, const PointsObservation& observation,
                                   double floor_px = 0.0);

using PoseVector = Eigen::Matrix<double, 6, 1>;
using PoseMatrix = Eigen::Matrix<double, 6, 6>;

/// cMl after a small move δ = (v, ω) in the camera frame: translation + v, rotation Exp(ω) · R. The
/// landmark turns about its own centre. All covariances of a cMl are of this δ.
Eigen::Isometry3d moved(const Eigen::Isometry3d& cMl, const PoseVector& delta);
/// The δ that takes @p from to @p to.
PoseVector move_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

/// The image of a point and how it moves.
struct PointImage {
  Eigen::Vector2d uv;
  Eigen::Matrix<double, 2, 6> duv_dpose;  ///< by δ, see moved()
  Eigen::Vector2d duv_dlog_focal;         ///< by ln of the focal length (px and py together)
};

/// Where the point is seen: the centre of the dot's image ellipse, in closed form from the dual
/// conic R²(I − nnᵀ) − ppᵀ of the circle: (p_z p + R² n_z n) / (p_z² − R²(1 − n_z²)); for R = 0 the
/// projection of the point. Mapped through the lens with the lens's curvature to first order in
/// kdu. Nothing when the dot is not wholly in front of the camera, its back is turned to it, or it
/// lies beyond the distortion's fold.
std::optional<PointImage> predict_point(const LandmarkPoint& point, const Intrinsics& intrinsics,
                                        const Eigen::Isometry3d& cMl);

/// What the points of one image say about δ and the log focal length, at a pose: the normal
/// equations of whitened least squares.
struct PointsFit {
  Eigen::Matrix<double, 7, 7> information;  ///< Jᵀ W J, of (v, ω, ln f)
  Eigen::Matrix<double, 7, 1> gradient;     ///< Jᵀ W (seen − predicted)
  double chi2 = 0.0;                        ///< Σ (seen − predicted)ᵀ W (seen − predicted)
};

/// Nothing when one of the points has no image from there.
std::optional<PointsFit> fit_points(const std::vector<SeenPoint>& points,
                                    const Intrinsics& intrinsics, const Eigen::Isometry3d& cMl);

/// What the points of one image say about (x, y, θ) and the look's biases (pan, tilt, log focal),
/// compressed without loss to six numbers at the point of linearisation x: y = H (truth − x) + e,
/// e ~ N(0, I). Rows that say nothing are zero: one at least, for a robot that turns about its
/// camera while the pan turns back leaves the image as it was.
struct PointsMeasurement {
  Eigen::Matrix<double, 6, 6> H;
  Eigen::Matrix<double, 6, 1> y;
  double chi2 = 0.0;  ///< Σ (seen − predicted)ᵀ W (seen − predicted)
};

/// Compresses the points of a landmark at wMl. Nothing when one of them has no image from there.
std::optional<PointsMeasurement> measure_points(const std::vector<SeenPoint>& points,
                                                const Eigen::Isometry3d& wMl, const Shot& shot,
                                                const RigOnGround& on_ground, const Pose2& pose,
                                                const LookBias& bias);

}  // namespace vigia::localization
