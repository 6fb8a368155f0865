#include "vigia/evaluation/pcrlb.hpp"

#include <cassert>

#include <Eigen/LU>

#include "vigia/localization/motion.hpp"

namespace vigia::evaluation {
namespace {

/// The tracker's covariance as it is, and no more.
localization::MeasurementParams measured_with(const SensorNoise& noise) {
  localization::MeasurementParams params;
  params.sensor = noise;
  return params;
}

}  // namespace

PosteriorBound::PosteriorBound(const Eigen::Matrix3d& prior, const RigOnGround& on_ground,
                               const SensorNoise& noise)
    : model_(LandmarkMap{}, on_ground, measured_with(noise)) {
  P_.topLeftCorner<3, 3>() = prior;
  begin_look(0);
}

void PosteriorBound::begin_look(LookId look) {
  look_ = look;
  P_.topRightCorner<3, 3>().setZero();
  P_.bottomLeftCorner<3, 3>().setZero();
  P_.bottomRightCorner<3, 3>() = localization::look_covariance(model_.params().sensor);
}

void PosteriorBound::predict(const Pose2& truth, const OdometryIncrement& increment,
                             const Eigen::Matrix3d& control) {
  P_ = localization::propagate_covariance(P_, truth, increment, control);
}

bool PosteriorBound::update(const Pose2& truth, const localization::LookBias& bias,
                            const Landmark& landmark, const Observation& observation) {
  const auto match = model_.match(observation, landmark);
  if (!match) return false;
  return model_.linearise(*match, localization::state_vector(truth, bias), [&](const auto& seen) {
    const Shot& shot = shot_of(observation);
    if (shot.look != look_ && model_.has_look_biases(shot.camera)) begin_look(shot.look);
    P_ = localization::updated_covariance(P_, seen);
    assert(P_.allFinite());
  });
}

void PosteriorBound::update(const Eigen::Matrix3d& information) {
  const Eigen::Matrix3d pose = covariance();
  // (P⁻¹ + I)⁻¹ without P⁻¹, which need not exist.
  const Eigen::Matrix3d updated =
      pose * (Eigen::Matrix3d::Identity() + information * pose).inverse();
  P_.topLeftCorner<3, 3>() = 0.5 * (updated + updated.transpose());
  assert(P_.allFinite());
}

}  // namespace vigia::evaluation
