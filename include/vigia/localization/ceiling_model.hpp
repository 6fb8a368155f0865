#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/ceiling_grid.hpp"
#include "vigia/core/image_shift.hpp"
#include "vigia/core/patch_image.hpp"
#include "vigia/core/pose.hpp"

namespace vigia::localization {

/// A camera that is fixed to the robot and looks up at a ceiling, as the robot knows it.
struct CeilingCamera {
  CameraModel model;
  Eigen::Isometry3d rMc = Eigen::Isometry3d::Identity();
  double ceiling_m = 2.7;  ///< height of the ceiling above the ground

  double rise_m() const { return ceiling_m - rMc.translation().z(); }
};

/// What is constant and not known of it: rRc is Exp(tilt_x, tilt_y, 0) times the known one, and the
/// ceiling is exp(log_height) times as far.
struct CeilingCameraErrors {
  double tilt_x = 0.0;  ///< rad about the robot's x
  double tilt_y = 0.0;
  double log_height = 0.0;

  Eigen::Vector3d vector() const { return {tilt_x, tilt_y, log_height}; }
  static CeilingCameraErrors from_vector(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }
};

/// The camera with the errors taken in.
CeilingCamera corrected(const CeilingCamera& camera, const CeilingCameraErrors& errors);

/// A patch's place and direction on the ceiling, in the robot's frame.
struct PatchOnCeiling {
  Eigen::Vector2d q = Eigen::Vector2d::Zero();               ///< m
  double psi = 0.0;                                          ///< rad
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (q, psi), by the image alone
  Eigen::Matrix3d derrors = Eigen::Matrix3d::Zero();         ///< ∂(q, psi)/∂errors
};

/// Nothing where the pixel does not show the ceiling.
std::optional<PatchOnCeiling> on_ceiling(const CeilingCamera& camera, const PatchImage& patch,
                                         const CeilingCameraErrors& errors = {});

/// As the image of a patch, which lies at @p patch for a camera with the errors @p from, tells its
/// place for one with the errors @p to. Of @p patch its place and direction are used.
PatchOnCeiling with_errors(const CeilingCamera& camera, const PatchOnCeiling& patch,
                           const CeilingCameraErrors& from, const CeilingCameraErrors& to);

/// The robot's motion by a camera's over the ceiling, which is levelled by the camera's rMc.
Pose2 robot_motion(const CeilingCamera& camera, const ImageShift& shift);

/// The other way round: what such a camera sees of the robot's motion.
ImageShift seen_shift(const CeilingCamera& camera, const Pose2& motion);

/// A motion as the flow shows it, in the robot's frame where it began.
struct FlowMotion {
  Pose2 step;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< by the image alone
  Eigen::Matrix3d derrors = Eigen::Matrix3d::Zero();         ///< ∂step/∂errors
};

/// The flow was levelled by the mounting as it was known. A tilt τ puts the vertical beside the
/// middle of what it took for level, at o = (−τy, τx), so that a turn seems to be a shift, too: s =
/// s′ − (I − R) o. What a tilt of the variance @p tilt_variance does besides, by where in the
/// picture the texture lies, is taken for noise. @p floor: σ of a shift beside what the match
/// claims, in distances to the ceiling.
FlowMotion flow_motion(const CeilingCamera& camera, const ImageShift& shift,
                       const CeilingCameraErrors& errors, double tilt_variance, double floor);

}  // namespace vigia::localization
