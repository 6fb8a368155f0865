#include "look_scheduler.hpp"

#include <algorithm>

namespace vigia::mission {

LookScheduler::LookScheduler(const MissionSetup& setup, const InformationModel& information,
                             std::uint64_t seed)
    : setup_(setup),
      information_(information),
      visibility_(setup.world.plan, setup.robot.robot.head, setup.robot.robot.head_limits,
                  setup.look.visibility),
      policy_(planner::make_look_policy(setup.look.policy, setup.look.fixed_landmark,
                                        RandomStream(seed, "look policy"))),
      trigger_(setup.look.trigger) {}

planner::LookDemand LookScheduler::demand(Stamp now, const Belief& belief, double travelled_m) {
  if (!asked_ || now - *asked_ >= Duration::from_seconds(setup_.look.period_s)) {
    asked_ = now;
    last_ = trigger_.demand(belief, travelled_m);
  }
  return last_;
}

std::optional<GazeOrder> LookScheduler::choose(Stamp now, const Belief& belief,
                                               const HeadReading& head, double station_m) {
  const Duration exclusion = Duration::from_seconds(setup_.look.exclude_s);
  failures_.erase(std::remove_if(failures_.begin(), failures_.end(),
                                 [&](const auto& f) { return now - f.second > exclusion; }),
                  failures_.end());
  std::vector<LandmarkId> excluded;
  for (const auto& failure : failures_) excluded.push_back(failure.first);

  const auto landmark =
      policy_->choose({now, belief, head, station_m, setup_.path, setup_.world.landmarks,
                       visibility_, information_, excluded});
  if (!landmark) return std::nullopt;
  GazeOrder order;
  order.look = next_look_++;
  order.landmark = *landmark;
  order.issued = now;
  order.expires = now + Duration::from_seconds(setup_.look.timeout_s);
  order.dwell_s = setup_.look.dwell_s;
  order.radius_px = setup_.look.radius_px;
  return order;
}

void LookScheduler::failed(Stamp now, LandmarkId landmark) {
  failures_.emplace_back(landmark, now);
}

}  // namespace vigia::mission
