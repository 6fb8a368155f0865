#pragma once

#include <Eigen/Core>

#include "vigia/core/odometry.hpp"
#include "vigia/localization/look_state.hpp"

namespace vigia::localization {

/// An increment as read, and the same at the mean speed of the last readings: the one whose
/// control_covariance() is that of the increment's error (see MeanSpeed).
struct Motion {
  OdometryIncrement increment;
  OdometryIncrement mean_speed;
};

/// F P Fᵀ + G Σ Gᵀ on the pose, the biases unmoved; F and G of the motion at @p pose.
Matrix6 propagate_covariance(const Matrix6& covariance, const Pose2& pose,
                             const OdometryIncrement& u, const Eigen::Matrix3d& control_covariance);

/// Moves the state on.
LookState propagate(const LookState& state, const Motion& motion, const OdometryNoise& noise);

/// The two parts of an increment before and after the fraction @p f of its time, at constant
/// speed and turn rate: moved one after the other they end where the whole ends. @p f may exceed 1
/// in the first part: extrapolation.
OdometryIncrement first_part(const OdometryIncrement& u, double f);
OdometryIncrement second_part(const OdometryIncrement& u, double f);
Motion first_part(const Motion& motion, double f);
Motion second_part(const Motion& motion, double f);

}  // namespace vigia::localization
