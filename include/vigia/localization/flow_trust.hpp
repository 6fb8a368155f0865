#pragma once

#include <Eigen/Core>

#include "vigia/core/odometry.hpp"
#include "vigia/localization/ceiling_model.hpp"

namespace vigia::localization {

/// Whether a flow keeps to the odometry over many frames. What one frame allows adds up: a flow of
/// things that hang below the ceiling is too fast by the same share all the time, and no frame of
/// it contradicts the wheels by itself. The differences of the last five seconds or so are summed
/// and held against the odometry's covariance over the same way and what height and tilt explain.
class FlowTrust {
 public:
  /// Takes a frame in. @p errors: covariance of the camera's errors as they are known. False: the
  /// sum is beyond the χ² @p gate of three numbers.
  bool holds(const OdometryIncrement& read, const OdometryNoise& noise, const FlowMotion& seen,
             const Eigen::Matrix3d& errors, double gate);

 private:
  Eigen::Vector3d difference_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  ///< of odometry and flow
  Eigen::Matrix3d derrors_ = Eigen::Matrix3d::Zero();
};

}  // namespace vigia::localization
