#include "vigia/localization/look_state.hpp"

namespace vigia::localization {

Vector6 state_vector(const Pose2& pose, const LookBias& bias) {
  Vector6 state;
  state << pose.vector(), bias.pan, bias.tilt, bias.log_focal;
  return state;
}

LookState initial_state(Stamp stamp, const Prior& prior, const SensorNoise& noise) {
  LookState state;
  state.stamp = stamp;
  state.mean.head<3>() = prior.pose.vector();
  state.covariance.topLeftCorner<3, 3>() = prior.covariance;
  return begin_look(state, 0, noise);
}

Eigen::Matrix3d look_covariance(const SensorNoise& noise) {
  const Eigen::Vector3d sigma(noise.look_angle, noise.look_angle, noise.look_focal);
  return sigma.cwiseAbs2().asDiagonal();
}

LookState begin_look(const LookState& state, LookId look, const SensorNoise& noise) {
  LookState fresh = state;
  fresh.look = look;
  fresh.mean.tail<3>().setZero();
  fresh.covariance.topRightCorner<3, 3>().setZero();
  fresh.covariance.bottomLeftCorner<3, 3>().setZero();
  fresh.covariance.bottomRightCorner<3, 3>() = look_covariance(noise);
  return fresh;
}

}  // namespace vigia::localization
