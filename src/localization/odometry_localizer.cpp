#include "vigia/localization/odometry_localizer.hpp"

#include "lost_probability.hpp"

namespace vigia::localization {

void OdometryLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  const Prior start = prior.value_or(anywhere());
  belief_ = Belief{};
  belief_.stamp = stamp;
  belief_.pose = start.pose;
  belief_.covariance = start.covariance;
  belief_.lost_probability = probability_of_half_a_metre(belief_.position_sigma());
  if (!prior) lose();
}

void OdometryLocalizer::lose() {
  belief_.status = BeliefStatus::lost;
  belief_.lost_probability = kSaidLost;
}

void OdometryLocalizer::predict(const OdometryIncrement& increment) {
  const Eigen::Matrix3d F = move_jacobian_pose(belief_.pose, increment);
  const Eigen::Matrix3d G = move_jacobian_control(belief_.pose, increment);
  belief_.covariance = F * belief_.covariance * F.transpose() +
                       G * control_covariance(increment, noise_) * G.transpose();
  belief_.pose = move(belief_.pose, increment);
  belief_.stamp = increment.to;
  if (belief_.status != BeliefStatus::lost)
    belief_.lost_probability = probability_of_half_a_metre(belief_.position_sigma());
}

UpdateResult OdometryLocalizer::update(const Observation& /*observation*/) {
  return {UpdateStatus::unsupported, std::nullopt, 0.0, 0};
}

}  // namespace vigia::localization
