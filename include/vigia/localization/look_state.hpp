#pragma once

#include <Eigen/Core>

#include "vigia/core/belief.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/disc_model.hpp"

namespace vigia::localization {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Gaussian over (x, y, θ, pan bias, tilt bias, log-focal bias). The biases are the errors of the
/// head's and the zoom's readings that are constant during a look: carried as state, they keep the
/// many frames of one look from counting as independent fixes.
struct LookState {
  Stamp stamp;
  Vector6 mean = Vector6::Zero();
  Matrix6 covariance = Matrix6::Zero();
  LookId look = 0;  ///< the look whose biases the state carries

  Pose2 pose() const { return Pose2::from_vector(mean.head<3>()); }
  LookBias bias() const { return {mean(3), mean(4), mean(5)}; }
  Eigen::Matrix3d pose_covariance() const { return covariance.topLeftCorner<3, 3>(); }
};

/// The point (x, y, θ, pan, tilt, log focal) of a pose and a look's biases.
Vector6 state_vector(const Pose2& pose, const LookBias& bias = {});

/// The state at the start, with the biases of no look yet.
LookState initial_state(Stamp stamp, const Prior& prior, const SensorNoise& noise);

/// A new look draws new biases: zero mean, prior covariance, no correlation with the pose.
LookState begin_look(const LookState& state, LookId look, const SensorNoise& noise);

/// Prior covariance of (pan, tilt, log-focal) bias.
Eigen::Matrix3d look_covariance(const SensorNoise& noise);

}  // namespace vigia::localization
