#include "vigia/localization/motion.hpp"

#include <cmath>

namespace vigia::localization {
namespace {

/// The part of an arc from fraction @p begin to @p end. The arc's chords all lie at the same angle
/// to the arc's tangents; the skew (rot1 − rot2)/2 turns them together.
OdometryIncrement part(const OdometryIncrement& u, double begin, double end) {
  const double share = end - begin;
  const double half_turn = 0.5 * (u.rot1 + u.rot2);
  const double skew = 0.5 * (u.rot1 - u.rot2);
  const bool straight = std::abs(half_turn) < 1e-9 || std::abs(half_turn) > 1.5;
  const double chord = straight ? share : std::sin(share * half_turn) / std::sin(half_turn);
  const double dt = (u.to - u.from).seconds();
  OdometryIncrement some{u.from + Duration::from_seconds(begin * dt),
                         u.from + Duration::from_seconds(end * dt),
                         share * half_turn + skew,
                         chord * u.trans,
                         share * half_turn - skew,
                         u.crab};
  if (u.covariance) some.covariance = share * *u.covariance;
  return some;
}

}  // namespace

Matrix6 propagate_covariance(const Matrix6& covariance, const Pose2& pose,
                             const OdometryIncrement& u,
                             const Eigen::Matrix3d& control_covariance) {
  const Eigen::Matrix3d F = move_jacobian_pose(pose, u);
  const Eigen::Matrix3d G = move_jacobian_control(pose, u);
  Matrix6 moved = covariance;
  moved.topLeftCorner<3, 3>() =
      F * covariance.topLeftCorner<3, 3>() * F.transpose() + G * control_covariance * G.transpose();
  moved.topRightCorner<3, 3>() = F * covariance.topRightCorner<3, 3>();
  moved.bottomLeftCorner<3, 3>() = moved.topRightCorner<3, 3>().transpose();
  return moved;
}

LookState propagate(const LookState& state, const Motion& motion, const OdometryNoise& noise) {
  LookState moved = state;
  moved.stamp = motion.increment.to;
  moved.mean.head<3>() = move(state.pose(), motion.increment).vector();
  moved.covariance = propagate_covariance(state.covariance, state.pose(), motion.increment,
                                          control_covariance(motion.mean_speed, noise));
  return moved;
}

OdometryIncrement first_part(const OdometryIncrement& u, double f) {
  return part(u, 0.0, f);
}

OdometryIncrement second_part(const OdometryIncrement& u, double f) {
  OdometryIncrement rest = part(u, f, 1.0);
  rest.to = u.to;
  return rest;
}

Motion first_part(const Motion& motion, double f) {
  return {first_part(motion.increment, f), first_part(motion.mean_speed, f)};
}

Motion second_part(const Motion& motion, double f) {
  return {second_part(motion.increment, f), second_part(motion.mean_speed, f)};
}

}  // namespace vigia::localization
