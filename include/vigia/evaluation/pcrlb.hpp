#pragma once

#include <vector>

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/disc_model.hpp"
#include "vigia/localization/points_model.hpp"

namespace vigia::evaluation {

/// Posterior Cramér–Rao bound along an executed drive: Tichavský's recursion in covariance form,
/// F P Fᵀ + G Σ Gᵀ followed by the measurement update, on (x, y, θ, pan bias, tilt bias, log-focal
/// bias), everything linearised at the true state. A look with a new id draws new biases. No
/// estimator that has the same prior and the same noise does better on average over many drives.
class PosteriorBound {
 public:
  /// @p prior: covariance of (x, y, θ) at the start. @p noise: of the head's and zoom's readings.
  PosteriorBound(const Eigen::Matrix3d& prior, const RigOnGround& on_ground,
                 const SensorNoise& noise);

  /// Moves from the true pose @p truth by the true @p increment, whose odometry has the covariance
  /// @p control of (rot1, trans, rot2).
  void predict(const Pose2& truth, const OdometryIncrement& increment,
               const Eigen::Matrix3d& control);

  /// Takes in one image of a disc: @p truth the pose at the exposure, @p sensor with the encoder's
  /// readings, @p bias the true errors of the look's readings, @p R the covariance of (u, v, s)
  /// in the image (the white part of the readings is added here). False, and nothing changed, when
  /// the disc has no image from there.
  bool update(const Pose2& truth, const Landmark& landmark, const Shot& shot,
              const localization::LookBias& bias, const Eigen::Matrix3d& R);

  /// Takes in one image of a pattern or tag, of which @p points were seen (their covariances count,
  /// not their pixels).
  bool update(const Pose2& truth, const Landmark& landmark, const Shot& shot,
              const localization::LookBias& bias,
              const std::vector<localization::SeenPoint>& points);

  /// The bound on the covariance of (x, y, θ).
  Eigen::Matrix3d covariance() const { return P_.topLeftCorner<3, 3>(); }

 private:
  void begin_look(LookId look);

  RigOnGround on_ground_;
  SensorNoise noise_;
  LookId look_ = 0;
  Eigen::Matrix<double, 6, 6> P_ = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace vigia::evaluation
