#include "vigia/evaluation/pcrlb.hpp"

#include <cassert>

#include "vigia/localization/ekf_state.hpp"

namespace vigia::evaluation {

PosteriorBound::PosteriorBound(const Eigen::Matrix3d& prior, const HeadGeometry& geometry,
                               const SensorNoise& noise)
    : geometry_(geometry), noise_(noise) {
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

bool PosteriorBound::update(const Pose2& truth, const Landmark& landmark,
                            const SensorSnapshot& sensor, const localization::LookBias& bias,
                            const Eigen::Matrix3d& R) {
  const auto image = localization::predict_disc(landmark, sensor, geometry_, truth, bias);
  if (!image) return false;
  if (sensor.look != look_) begin_look(sensor.look);
  const localization::Matrix36 H = localization::state_jacobian(*image);
  const Eigen::Matrix3d total = R + localization::reading_covariance(*image, noise_);
  const auto K = localization::kalman_gain(P_, H, total);
  P_ = localization::joseph_update(P_, H, K, total);
  assert(P_.allFinite());
  return true;
}

}  // namespace vigia::evaluation
