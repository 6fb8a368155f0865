#pragma once

#include <optional>

#include <Eigen/Core>

#include "vigia/core/camera.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/rig.hpp"

namespace vigia::localization {

/// The image of a disc landmark in closed form: the exact perspective conic of the circle, its
/// centre and axes (not the projection of the disc's centre, PAPERS: Armingol errata), mapped
/// through the lens: linearly at the ellipse's centre, and the lens's curvature to first order in
/// kdu for the centre and the area of the bent ellipse (centre to 0.01 px at kdu = 0.05 and 60 px).
/// Nothing when the disc is not wholly in front of the camera, edge on, or seen from behind.
std::optional<Ellipse> disc_image(const Landmark& landmark, const Intrinsics& intrinsics,
                                  const Eigen::Isometry3d& wMc);

/// Errors of the readings that are constant during a look: true = reading + error.
struct LookBias {
  double pan = 0.0;
  double tilt = 0.0;
  double log_focal = 0.0;  ///< true focal length = exp(log_focal) · calibrated
};

/// The measurement z = (u, v, s) of a disc and its Jacobians: the ellipse's centre in pixels and
/// the logarithm of its size, s = ln √(ab). The size is that of the area, not the semi-major axis:
/// near a frontal view the axes are nearly equal, noise makes the longer one longer still, and
/// which is the longer one jumps with the pose; √(ab) is unbiased and smooth there. In closed form,
/// without distortion: s = ln f + ln R + ½ ln |n·p| − ¾ ln(p_z² − R²(1 − n_z²)), p the disc's
/// centre and n its normal in the camera frame.
struct DiscMeasurement {
  Eigen::Vector3d z;
  Eigen::Matrix3d dz_dpose;  ///< ∂z/∂(x, y, θ)
  Eigen::Matrix3d dz_dbias;  ///< ∂z/∂(pan, tilt, log_focal)
};

/// Predicts (u, v, ln √(ab)) with analytic Jacobians. Nothing where disc_image() has nothing.
std::optional<DiscMeasurement> predict_disc(const Landmark& landmark, const Shot& shot,
                                            const RigOnGround& on_ground, const Pose2& pose,
                                            const LookBias& bias);

/// The observed (u, v, ln √(ab)) and its covariance, from an ellipse and its 5×5 covariance.
Eigen::Vector3d measured_disc(const EllipseObservation& observation);
Eigen::Matrix3d measured_disc_covariance(const EllipseObservation& observation);

}  // namespace vigia::localization
