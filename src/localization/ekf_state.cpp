#include "vigia/localization/ekf_state.hpp"

#include <cmath>

#include <Eigen/Cholesky>

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
  return {u.from + Duration::from_seconds(begin * dt), u.from + Duration::from_seconds(end * dt),
          share * half_turn + skew, chord * u.trans, share * half_turn - skew};
}

}  // namespace

const Shot* shot_of(const EkfInput& input) {
  if (const auto* disc = std::get_if<DiscFix>(&input)) return &disc->shot;
  if (const auto* points = std::get_if<PointsFix>(&input)) return &points->shot;
  return nullptr;
}

EkfState initial_state(Stamp stamp, const Prior& prior, const SensorNoise& noise) {
  EkfState state;
  state.stamp = stamp;
  state.mean.head<3>() = prior.pose.vector();
  state.covariance.topLeftCorner<3, 3>() = prior.covariance;
  return begin_look(state, 0, noise);
}

Eigen::Matrix3d look_covariance(const SensorNoise& noise) {
  const Eigen::Vector3d sigma(noise.look_angle, noise.look_angle, noise.look_focal);
  return sigma.cwiseAbs2().asDiagonal();
}

EkfState begin_look(const EkfState& state, LookId look, const SensorNoise& noise) {
  EkfState fresh = state;
  fresh.look = look;
  fresh.mean.tail<3>().setZero();
  fresh.covariance.topRightCorner<3, 3>().setZero();
  fresh.covariance.bottomLeftCorner<3, 3>().setZero();
  fresh.covariance.bottomRightCorner<3, 3>() = look_covariance(noise);
  return fresh;
}

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

EkfState propagate(const EkfState& state, const Motion& motion, const OdometryNoise& noise) {
  EkfState moved = state;
  moved.stamp = motion.increment.to;
  moved.mean.head<3>() = move(state.pose(), motion.increment).vector();
  moved.covariance = propagate_covariance(state.covariance, state.pose(), motion.increment,
                                          control_covariance(motion.even, noise));
  return moved;
}

Matrix36 state_jacobian(const DiscMeasurement& predicted) {
  Matrix36 H;
  H << predicted.dz_dpose, predicted.dz_dbias;
  return H;
}

Eigen::Matrix3d reading_covariance(const DiscMeasurement& predicted, const SensorNoise& noise) {
  const Eigen::Matrix<double, 3, 2> J = predicted.dz_dbias.leftCols<2>();
  return noise.reading_angle * noise.reading_angle * J * J.transpose();
}

Matrix6 reading_covariance(const PointsMeasurement& measured, const SensorNoise& noise) {
  const Eigen::Matrix<double, 6, 2> J = measured.H.middleCols<2>(3);
  return Matrix6::Identity() + noise.reading_angle * noise.reading_angle * J * J.transpose();
}

Matrix6 joseph_update(const Matrix6& covariance, const Matrix36& H,
                      const Eigen::Matrix<double, 6, 3>& K, const Eigen::Matrix3d& R) {
  const Matrix6 I_KH = Matrix6::Identity() - K * H;
  const Matrix6 updated = I_KH * covariance * I_KH.transpose() + K * R * K.transpose();
  return 0.5 * (updated + updated.transpose());
}

Eigen::Matrix<double, 6, 3> kalman_gain(const Matrix6& covariance, const Matrix36& H,
                                        const Eigen::Matrix3d& R) {
  const Eigen::Matrix<double, 3, 6> HP = H * covariance;
  const Eigen::Matrix3d S = HP * H.transpose() + R;
  return S.ldlt().solve(HP).transpose();
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
  return {first_part(motion.increment, f), first_part(motion.even, f)};
}

Motion second_part(const Motion& motion, double f) {
  return {second_part(motion.increment, f), second_part(motion.even, f)};
}

}  // namespace vigia::localization
