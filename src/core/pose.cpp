#include "vigia/core/pose.hpp"

namespace vigia {

Pose2 compose(const Pose2& aMb, const Pose2& bMc) {
  const double c = std::cos(aMb.theta);
  const double s = std::sin(aMb.theta);
  return {aMb.x + c * bMc.x - s * bMc.y, aMb.y + s * bMc.x + c * bMc.y,
          wrap_angle(aMb.theta + bMc.theta)};
}

Pose2 inverse(const Pose2& aMb) {
  const double c = std::cos(aMb.theta);
  const double s = std::sin(aMb.theta);
  return {-c * aMb.x - s * aMb.y, s * aMb.x - c * aMb.y, wrap_angle(-aMb.theta)};
}

Eigen::Vector3d difference(const Pose2& a, const Pose2& b) {
  return {a.x - b.x, a.y - b.y, wrap_angle(a.theta - b.theta)};
}

Eigen::Isometry3d to_isometry(const Pose2& pose, double z) {
  Eigen::Isometry3d wMr = Eigen::Isometry3d::Identity();
  const double c = std::cos(pose.theta);
  const double s = std::sin(pose.theta);
  wMr.linear() << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  wMr.translation() = Eigen::Vector3d(pose.x, pose.y, z);
  return wMr;
}

}  // namespace vigia
