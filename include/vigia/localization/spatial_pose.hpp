#pragma once

#include <Eigen/Core>

#include "vigia/core/belief.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/points_pose.hpp"

namespace vigia::localization {

/// The robot from one landmark: wMr = wMl · cMl⁻¹ · rMc⁻¹ at the head's readings. The covariance
/// holds the fit's own and, to first order, the errors of the readings (constant and white part)
/// and of the focal length; they make it larger in one image and are common to all of a look.
SpatialPose robot_in_space(const Landmark& landmark, const FittedPose& fit, const Shot& shot,
                           const RigOnGround& on_ground, const SensorNoise& noise);

/// Height and attitude of the floor under the robot, as a pose in space shows them.
struct FloorAttitude {
  double z_m = 0.0;
  double pitch = 0.0;                                    ///< rad, positive: the robot's front is up
  double roll = 0.0;                                     ///< rad, positive: the robot's left is up
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (z, pitch, roll)
};

/// What a ramp does to the robot: height, pitch and roll of its base.
FloorAttitude floor_attitude(const SpatialPose& pose);

/// The pose seen from above the ground under it: (x, y, θ) in plan coordinates and its covariance;
/// θ is the direction of the robot's front projected on the ground.
struct PlanarEstimate {
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};
PlanarEstimate seen_from_above(const SpatialPose& pose, const Ground& ground = {});

/// Moves the robot by an odometry increment in the plane of its own wheels; where the ground is not
/// flat, as a robot would turn and rise that stands on it where this one is seen from above.
SpatialPose moved_by(const SpatialPose& pose, const OdometryIncrement& u,
                     const OdometryNoise& noise, const Ground& ground = {});

}  // namespace vigia::localization
