#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/pose.hpp"
#include "vigia/core/stamp.hpp"

namespace vigia {

enum class BeliefStatus { tracking, ambiguous, lost };

std::string_view to_string(BeliefStatus status);

/// A weighted alternative of an ambiguous belief.
struct PoseHypothesis {
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double weight = 1.0;
};

/// A pose in space. Covariance of (δp, δφ) in world axes: p + δp, Exp(δφ) · R.
struct SpatialPose {
  Eigen::Isometry3d wMr = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Where a localizer believes the robot is: planar pose with covariance of (x, y, θ).
struct Belief {
  Stamp stamp;
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  BeliefStatus status = BeliefStatus::tracking;
  std::vector<PoseHypothesis> hypotheses;  ///< empty unless ambiguous
  std::optional<SpatialPose> in_space;     ///< from methods that measure it
  /// Probability of being lost, by the localizer's own evidence: that the position is off by more
  /// than half a metre or four times the claimed σ. Not calibrated unless the localizer says so.
  double lost_probability = 0.0;

  /// √λ_max of the position covariance, metres: what the uncertainty limits compare.
  double position_sigma() const;
};

/// What a mission says about its start.
struct Prior {
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// The prior of a robot that may be anywhere: σ of 100 m and of half a turn.
Prior anywhere();

}  // namespace vigia
