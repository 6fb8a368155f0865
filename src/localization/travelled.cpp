#include "vigia/localization/travelled.hpp"

namespace vigia::localization {

void travel(StationMotion& motion, const OdometryIncrement& u, const OdometryNoise& noise) {
  const Pose2 from{motion.displacement_m.x(), motion.displacement_m.y(), motion.turn};
  const Eigen::Matrix3d F = move_jacobian_pose(from, u);
  const Eigen::Matrix3d G = move_jacobian_control(from, u);
  const Pose2 to = move(from, u);
  motion.frame = MotionFrame::body;
  motion.displacement_m = to.position();
  motion.turn = to.theta;
  motion.covariance =
      F * motion.covariance * F.transpose() + G * control_covariance(u, noise) * G.transpose();
}

}  // namespace vigia::localization
