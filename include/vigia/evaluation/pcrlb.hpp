#pragma once

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/measurement_model.hpp"

namespace vigia::evaluation {

/// Posterior Cramér–Rao bound along an executed drive: Tichavský's recursion in covariance form,
/// F P Fᵀ + G Σ Gᵀ followed by the measurement update, on (x, y, θ, pan bias, tilt bias, log-focal
/// bias), everything linearised at the true state. A look with a new id draws new biases. No
/// estimator that has the same prior and the same noise does better on average over many drives.
class PosteriorBound {
 public:
  /// @p prior: covariance of (x, y, θ) at the start. @p noise: of the head's and zoom's readings.
  PosteriorBound(const Eigen::Matrix3d& prior, const RigOnGround& on_ground,
                 const SensorNoise& noise);

  /// Moves from the true pose @p truth by the true @p increment, whose odometry has the covariance
  /// @p control of (rot1, trans, rot2).
  void predict(const Pose2& truth, const OdometryIncrement& increment,
               const Eigen::Matrix3d& control);

  /// Updates by one image of @p landmark, which it truly shows: @p truth the pose at the exposure,
  /// @p bias the true errors of the look's readings. Of the observation its readings and its
  /// covariance count, not its pixels. False, and nothing changed, when the landmark has no image
  /// from there.
  bool update(const Pose2& truth, const localization::LookBias& bias, const Landmark& landmark,
              const Observation& observation);

  /// Updates by what an image of a field truly says of (x, y, θ).
  void update(const Eigen::Matrix3d& information);

  /// The bound on the covariance of (x, y, θ).
  Eigen::Matrix3d covariance() const { return P_.topLeftCorner<3, 3>(); }

 private:
  void begin_look(LookId look);

  localization::MeasurementModel model_;
  LookId look_ = 0;
  Eigen::Matrix<double, 6, 6> P_ = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace vigia::evaluation
