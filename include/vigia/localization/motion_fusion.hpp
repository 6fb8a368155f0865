#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/odometry.hpp"
#include "vigia/localization/ceiling_model.hpp"

namespace vigia::localization {

/// What wheels and flow say together of a motion, in the robot's frame where it began.
struct FusedMotion {
  Pose2 step;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d flow_weight = Eigen::Matrix3d::Zero();  ///< ∂step/∂(the flow's step)
};

/// Covariance of what the odometry reads of a motion, in the robot's frame where it began, over the
/// way that the flow shows.
Eigen::Matrix3d motion_covariance(const OdometryIncrement& read, const OdometryNoise& noise,
                                  const FlowMotion& seen);

/// The flow as a measurement of the motion that the odometry predicts. The odometry's variance is
/// that of the way which the flow shows: by its own reading, one that came out too short would be
/// too sure. Where it reads nothing at all and the flow does not contradict it, the robot stands.
/// Nothing where the two exclude each other: χ² of three numbers above @p gate, a centimetre more
/// of σ allowed for what is constant in the flow and not known.
std::optional<FusedMotion> fuse_motions(const OdometryIncrement& read, const OdometryNoise& noise,
                                        const FlowMotion& seen, double gate);

/// Increments one after the other, as one.
OdometryIncrement joined(const std::vector<OdometryIncrement>& parts);

/// The increment that such a motion is, with its covariance. What a motion without way has of
/// sideways error is left out: no increment says it.
OdometryIncrement as_increment(const FusedMotion& motion, const OdometryIncrement& read);

}  // namespace vigia::localization
