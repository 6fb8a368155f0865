#pragma once

#include <optional>

#include <Eigen/Core>

#include "vigia/core/belief.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/range_scan.hpp"
#include "vigia/pilot/pilot_params.hpp"

namespace vigia::pilot {

/// Where the base is among the walls near it: an extended Kalman filter of the range ring's scans
/// against the floor plan, one scan after the other carried on by odometry. It begins with the
/// belief and is the pilot's own: walls tell where the door is better than landmarks across the
/// hall do, and nothing of it goes back to the belief.
class RingFix {
 public:
  /// @p plan must outlive it.
  RingFix(const FloorPlan& plan, RingParams params) : plan_(&plan), params_(params) {}

  /// @p doubt: the belief's σ count so many times.
  void begin(const Belief& belief, double doubt = 1.0);
  void predict(const OdometryIncrement& odometry);
  void update(const RangeScan& scan);

  const Pose2& pose() const { return pose_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }
  /// Whether the latest scans show what is seen from pose().
  bool agrees() const;
  /// σ of the position across @p direction, a unit vector.
  double sigma_across(const Eigen::Vector2d& direction) const;

 private:
  const FloorPlan* plan_;
  RingParams params_;
  Pose2 pose_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
  int scans_ = 0;
  double agreement_ = 0.0;
};

}  // namespace vigia::pilot
