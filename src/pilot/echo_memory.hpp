#pragma once

#include <vector>

#include <Eigen/Core>

#include "vigia/core/odometry.hpp"
#include "vigia/core/range_scan.hpp"
#include "vigia/pilot/pilot_params.hpp"

namespace vigia::pilot {

/// Something that the floor plan does not explain.
struct Echo {
  Eigen::Vector2d front_r;  ///< its near side in the base frame, m
  int hits = 1;             ///< scans that showed it, less those that saw through it
  Stamp seen;
};

/// The unknown things round the robot, in the base frame.
class EchoMemory {
 public:
  explicit EchoMemory(RingParams params) : params_(params) {}

  /// The robot has moved.
  void carry(const OdometryIncrement& odometry);
  /// A scan, of which @p unexplained says which echoes no wall accounts for.
  void take(const RangeScan& scan, const std::vector<char>& unexplained);
  /// Forgets what has not been seen for long.
  void forget(Stamp now);

  bool confirmed(const Echo& echo) const { return echo.hits >= params_.confirmations; }
  const std::vector<Echo>& echoes() const { return echoes_; }

 private:
  void note(const Eigen::Vector2d& front_r, Stamp now);
  void see_through(const RangeScan& scan);

  RingParams params_;
  std::vector<Echo> echoes_;
};

}  // namespace vigia::pilot
