#include "vigia/core/odometry.hpp"

#include <cmath>

namespace vigia {

Eigen::Matrix3d control_covariance(const OdometryIncrement& u, const OdometryNoise& noise) {
  if (u.covariance) return *u.covariance;
  const double distance = std::abs(u.trans);
  const double turned = std::abs(u.rot1 - u.crab) + std::abs(u.rot2 + u.crab);
  const double rotation = noise.rot_per_sqrt_m * noise.rot_per_sqrt_m * distance +
                          noise.rot_per_sqrt_rad * noise.rot_per_sqrt_rad * turned;
  const double translation = noise.trans_per_sqrt_m * noise.trans_per_sqrt_m * distance;
  return Eigen::Vector3d(0.5 * rotation, translation, 0.5 * rotation).asDiagonal();
}

Pose2 move(const Pose2& pose, const OdometryIncrement& u) {
  // Armingol eq. 6, corrected.
  const double direction = pose.theta + u.rot1;
  return {pose.x + u.trans * std::cos(direction), pose.y + u.trans * std::sin(direction),
          wrap_angle(direction + u.rot2)};
}

Eigen::Matrix3d move_jacobian_pose(const Pose2& pose, const OdometryIncrement& u) {
  const double direction = pose.theta + u.rot1;
  Eigen::Matrix3d dx_dx = Eigen::Matrix3d::Identity();
  dx_dx(0, 2) = -u.trans * std::sin(direction);
  dx_dx(1, 2) = u.trans * std::cos(direction);
  return dx_dx;
}

Eigen::Matrix3d move_jacobian_control(const Pose2& pose, const OdometryIncrement& u) {
  const double c = std::cos(pose.theta + u.rot1);
  const double s = std::sin(pose.theta + u.rot1);
  Eigen::Matrix3d dx_du;
  dx_du << -u.trans * s, c, 0.0, u.trans * c, s, 0.0, 1.0, 0.0, 1.0;
  return dx_du;
}

OdometryIncrement chord_increment(const Pose2& before, const Pose2& after, double turned,
                                  Stamp from, Stamp to) {
  const Pose2 moved = compose(inverse(before), after);
  OdometryIncrement u{from, to, 0.5 * turned, 0.0, 0.0};
  const double chord = std::hypot(moved.x, moved.y);
  if (chord > 1e-9) {  // below, the chord's direction is rounding error
    const double bearing = std::atan2(moved.y, moved.x);
    const bool backward = std::cos(bearing - 0.5 * turned) < 0.0;
    u.trans = backward ? -chord : chord;
    u.rot1 = backward ? wrap_angle(bearing + kPi) : bearing;
  }
  u.rot2 = turned - u.rot1;
  return u;
}

OdometryIncrement crab_increment(const Pose2& before, const Pose2& after, double turned, Stamp from,
                                 Stamp to) {
  const Pose2 moved = compose(inverse(before), after);
  OdometryIncrement u{from, to, 0.5 * turned, 0.0, 0.5 * turned};
  const double chord = std::hypot(moved.x, moved.y);
  if (chord <= 1e-9) return u;  // the chord's direction is rounding error
  u.trans = chord;
  u.crab = wrap_angle(std::atan2(moved.y, moved.x) - 0.5 * turned);
  u.rot1 += u.crab;
  u.rot2 -= u.crab;
  return u;
}

OdometryIncrement arc_increment(double v, double w, Stamp from, Stamp to) {
  const double dt = (to - from).seconds();
  const double half = 0.5 * w * dt;
  const double sinc = std::abs(half) < 1e-6 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  return {from, to, half, v * dt * sinc, half};
}

OdometryIncrement arc_increment(const BaseRates& rates, Stamp from, Stamp to) {
  if (rates.vy == 0.0) return arc_increment(rates.v, rates.w, from, to);
  OdometryIncrement u = arc_increment(std::hypot(rates.v, rates.vy), rates.w, from, to);
  u.crab = std::atan2(rates.vy, rates.v);
  u.rot1 += u.crab;
  u.rot2 -= u.crab;
  return u;
}

BaseRates mean_rates(const OdometryIncrement& u) {
  const double dt = (u.to - u.from).seconds();
  return {u.trans * std::cos(u.crab) / dt, (u.rot1 + u.rot2) / dt, u.trans * std::sin(u.crab) / dt};
}

}  // namespace vigia
