#pragma once

#include <string_view>
#include <vector>

#include <Eigen/Core>

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

/// Where a localizer believes the robot is: planar pose with covariance of (x, y, θ).
struct Belief {
  Stamp stamp;
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  BeliefStatus status = BeliefStatus::tracking;
  std::vector<PoseHypothesis> hypotheses;  ///< empty unless ambiguous

  /// √λ_max of the position covariance, metres: what the uncertainty limits compare.
  double position_sigma() const;
};

/// What a mission says about its start.
struct Prior {
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

}  // namespace vigia
