#include "vigia/evaluation/pcrlb.hpp"

#include <cassert>

#include <Eigen/Cholesky>

#include "vigia/localization/ekf_state.hpp"

namespace vigia::evaluation {

PosteriorBound::PosteriorBound(const Eigen::Matrix3d& prior, const RigOnGround& on_ground,
                               const SensorNoise& noise)
    : on_ground_(on_ground), noise_(noise) {
  P_.topLeftCorner<3, 3>() = prior;
  begin_look(0);
}

void PosteriorBound::begin_look(LookId look) {
  look_ = look;
  P_.topRightCorner<3, 3>().setZero();
  P_.bottomLeftCorner<3, 3>().setZero();
  P_.bottomRightCorner<3, 3>() = localization::look_covariance(noise_);
}

void PosteriorBound::predict(const Pose2& truth, const OdometryIncrement& increment,
                             const Eigen::Matrix3d& control) {
  P_ = localization::propagate_covariance(P_, truth, increment, control);
}

bool PosteriorBound::update(const Pose2& truth, const Landmark& landmark, const Shot& shot,
                            const localization::LookBias& bias, const Eigen::Matrix3d& R) {
  const auto image = localization::predict_disc(landmark, shot, on_ground_, truth, bias);
  if (!image) return false;
  if (shot.look != look_) begin_look(shot.look);
  const localization::Matrix36 H = localization::state_jacobian(*image);
  const Eigen::Matrix3d total = R + localization::reading_covariance(*image, noise_);
  const auto K = localization::kalman_gain(P_, H, total);
  P_ = localization::joseph_update(P_, H, K, total);
  assert(P_.allFinite());
  return true;
}

bool PosteriorBound::update(const Pose2& truth, const Landmark& landmark, const Shot& shot,
                            const localization::LookBias& bias,
                            const std::vector<localization::SeenPoint>& points) {
  const auto image =
      localization::measure_points(points, landmark.wMl, shot, on_ground_, truth, bias);
  if (!image) return false;
  if (shot.look != look_) begin_look(shot.look);
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  const Matrix6 R = localization::reading_covariance(*image, noise_);
  const Matrix6 HP = image->H * P_;
  const Matrix6 K = (HP * image->H.transpose() + R).ldlt().solve(HP).transpose();
  const Matrix6 I_KH = Matrix6::Identity() - K * image->H;
  const Matrix6 updated = I_KH * P_ * I_KH.transpose() + K * R * K.transpose();
  P_ = 0.5 * (updated + updated.transpose());
  assert(P_.allFinite());
  return true;
}

}  // namespace vigia::evaluation
