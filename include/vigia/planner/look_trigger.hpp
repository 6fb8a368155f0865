#pragma once

#include "vigia/core/belief.hpp"

namespace vigia::planner {

struct LookTriggerParams {
  enum class Kind { distance, uncertainty };
  Kind kind = Kind::distance;
  double distance_m = 1.0;  ///< travelled (by odometry) between looks
  double limit_1_m = 0.05;  ///< √λ_max above which the robot relocalises in motion
  double limit_2_m = 0.10;  ///< √λ_max above which it stops first
  double goal_m = 0.0;      ///< of the path's end, on which goal_limit_m takes limit_1_m's place
  double goal_limit_m = 0.02;
};

enum class LookDemand { none, in_motion, stopped };

/// When to look (Armingol §3): after a distance, or by two limits of the position's uncertainty.
class LookTrigger {
 public:
  explicit LookTrigger(LookTriggerParams params) : params_(params) {}

  /// @p travelled_m: distance driven since the mission's start, by odometry. A stop, once demanded,
  /// is demanded until the uncertainty is below limit_1_m again.
  /// @p remaining_m: to the path's end.
  LookDemand demand(const Belief& belief, double travelled_m, double remaining_m);
  /// A look was fused at this distance.
  void looked(double travelled_m) { last_look_m_ = travelled_m; }

 private:
  LookTriggerParams params_;
  double last_look_m_ = -1e9;
  bool stopping_ = false;
};

}  // namespace vigia::planner
