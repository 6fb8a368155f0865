#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/belief.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/disc_model.hpp"
#include "vigia/localization/points_model.hpp"

namespace vigia::localization {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// Gaussian over (x, y, θ, pan bias, tilt bias, log-focal bias). The biases are the errors of the
/// head's and the zoom's readings that are constant during a look: carried as state, they keep the
/// many frames of one look from counting as independent fixes.
struct EkfState {
  Stamp stamp;
  Vector6 mean = Vector6::Zero();
  Matrix6 covariance = Matrix6::Zero();
  LookId look = 0;  ///< the look whose biases the state carries

  Pose2 pose() const { return Pose2::from_vector(mean.head<3>()); }
  LookBias bias() const { return {mean(3), mean(4), mean(5)}; }
  Eigen::Matrix3d pose_covariance() const { return covariance.topLeftCorner<3, 3>(); }
};

/// An image of a disc whose landmark is known.
struct DiscFix {
  Shot shot;
  Landmark landmark;
  Eigen::Vector3d z;  ///< as measured_disc()
  Eigen::Matrix3d R;  ///< of z in the image; the white part of the readings comes on top
};

/// An image of a landmark that says who it is: a pattern's dots or a tag's corners.
struct PointsFix {
  Shot shot;
  Landmark landmark;
  std::vector<SeenPoint> points;
};

/// An increment, and the one whose control_covariance() is that of its error.
struct Motion {
  OdometryIncrement increment;
  OdometryIncrement even;
};

/// What moves the filter on.
using EkfInput = std::variant<Motion, DiscFix, PointsFix>;

/// The shot of an image; nullptr for an increment.
const Shot* shot_of(const EkfInput& input);

/// The state at the start, with the biases of no look yet.
EkfState initial_state(Stamp stamp, const Prior& prior, const SensorNoise& noise);

/// A new look draws new biases: zero mean, prior covariance, no correlation with the pose.
EkfState begin_look(const EkfState& state, LookId look, const SensorNoise& noise);

/// Prior covariance of (pan, tilt, log-focal) bias.
Eigen::Matrix3d look_covariance(const SensorNoise& noise);

/// F P Fᵀ + G Σ Gᵀ on the pose, the biases unmoved; F and G of the motion at @p pose.
Matrix6 propagate_covariance(const Matrix6& covariance, const Pose2& pose,
                             const OdometryIncrement& u, const Eigen::Matrix3d& control_covariance);

/// Moves the state on.
EkfState propagate(const EkfState& state, const Motion& motion, const OdometryNoise& noise);

/// ∂z/∂state of a predicted disc.
Matrix36 state_jacobian(const DiscMeasurement& predicted);

/// Covariance that the white part of the head's readings adds to a measurement.
Eigen::Matrix3d reading_covariance(const DiscMeasurement& predicted, const SensorNoise& noise);

/// Covariance of a points measurement's error: that of the pixels, which is the unit matrix, and
/// what the white part of the head's readings adds.
Matrix6 reading_covariance(const PointsMeasurement& measured, const SensorNoise& noise);

/// P − K S Kᵀ in Joseph's form, symmetrised. S = H P Hᵀ + R must be positive definite.
Matrix6 joseph_update(const Matrix6& covariance, const Matrix36& H,
                      const Eigen::Matrix<double, 6, 3>& K, const Eigen::Matrix3d& R);

/// P Hᵀ (H P Hᵀ + R)⁻¹.
Eigen::Matrix<double, 6, 3> kalman_gain(const Matrix6& covariance, const Matrix36& H,
                                        const Eigen::Matrix3d& R);

/// The two parts of an increment before and after the fraction @p f of its time, at constant
/// speed and turn rate: moved one after the other they end where the whole ends. @p f may exceed 1
/// in the first part: extrapolation.
OdometryIncrement first_part(const OdometryIncrement& u, double f);
OdometryIncrement second_part(const OdometryIncrement& u, double f);
Motion first_part(const Motion& motion, double f);
Motion second_part(const Motion& motion, double f);

}  // namespace vigia::localization
