#include "vigia/localization/odometry_localizer.hpp"

namespace vigia::localization {

void OdometryLocalizer::reset(Stamp stamp, const Prior& prior) {
  belief_ = Belief{};
  belief_.stamp = stamp;
  belief_.pose = prior.pose;
  belief_.covariance = prior.covariance;
}

void OdometryLocalizer::predict(const OdometryIncrement& increment) {
  const Eigen::Matrix3d F = move_jacobian_pose(belief_.pose, increment);
  const Eigen::Matrix3d G = move_jacobian_control(belief_.pose, increment);
  belief_.covariance = F * belief_.covariance * F.transpose() +
                       G * control_covariance(increment, noise_) * G.transpose();
  belief_.pose = move(belief_.pose, increment);
  belief_.stamp = increment.to;
}

UpdateResult OdometryLocalizer::update(const Observation& /*observation*/) {
  return {UpdateStatus::unsupported, std::nullopt, 0.0, 0};
}

}  // namespace vigia::localization
