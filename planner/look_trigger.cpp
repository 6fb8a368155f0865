#include "vigia/planner/look_trigger.hpp"

namespace vigia::planner {

LookDemand LookTrigger::demand(const Belief& belief, double travelled_m, double remaining_m) {
  if (params_.kind == LookTriggerParams::Kind::distance)
    return travelled_m - last_look_m_ >= params_.distance_m ? LookDemand::in_motion
                                                            : LookDemand::none;

  const double sigma = belief.position_sigma();
  if (sigma > params_.limit_2_m) stopping_ = true;
  if (sigma < params_.limit_1_m) stopping_ = false;
  if (stopping_) return LookDemand::stopped;
  const double limit = remaining_m < params_.goal_m ? params_.goal_limit_m : params_.limit_1_m;
  return sigma > limit ? LookDemand::in_motion : LookDemand::none;
}

}  // namespace vigia::planner
