#pragma once

#include <optional>

#include <Eigen/Core>

#include "vigia/core/camera.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/pose.hpp"

namespace vigia::localization {

/// The image of a disc landmark in closed form: the exact perspective conic of the circle, its
/// centre and axes (not the projection of the disc's centre, PAPERS: Armingol errata), mapped
/// through the lens distortion at the ellipse's centre.
/// Nothing when the disc is not wholly in front of the camera or seen from behind.
std::optional<Ellipse> disc_image(const Landmark& landmark, const Intrinsics& intrinsics,
                                  const Eigen::Isometry3d& wMc);

/// Errors of the readings that are constant during a look: true = reading + error.
struct LookBias {
  double pan = 0.0;
  double tilt = 0.0;
  double log_focal = 0.0;  ///< true focal length = exp(log_focal) · calibrated
};

/// The measurement z = (u, v, log a) of a disc and its Jacobians.
struct DiscMeasurement {
  Eigen::Vector3d z;
  Eigen::Matrix3d dz_dpose;  ///< ∂z/∂(x, y, θ)
  Eigen::Matrix3d dz_dbias;  ///< ∂z/∂(pan, tilt, log_focal)
};

/// Predicts (u, v, log a) with analytic Jacobians.
std::optional<DiscMeasurement> predict_disc(const Landmark& landmark, const SensorSnapshot& sensor,
                                            const HeadGeometry& geometry, const Pose2& pose,
                                            const LookBias& bias);

/// The observed (u, v, log a) and its covariance, from an ellipse and its 5×5 covariance.
Eigen::Vector3d measured_disc(const EllipseObservation& observation);
Eigen::Matrix3d measured_disc_covariance(const EllipseObservation& observation);

}  // namespace vigia::localization
