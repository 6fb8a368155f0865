#include "look_scheduler.hpp"

#include <algorithm>

#include "vigia/mission/planning_parts.hpp"
#include "vigia/planner/apparent_size.hpp"
#include "vigia/servo/slew_law.hpp"

namespace vigia::mission {
namespace {

constexpr int kMostDoublings = 4;
constexpr double kSearch_s = 2.0;  // of a look, once head and zoom are there

/// What a look may take: as long as the mission says, and no less than head and zoom need from end
/// to end and the search after that.
Duration time_for_look(const MissionSetup& setup) {
  const HeadLimits& head = setup.robot.robot.head_limits;
  const auto& zoom = setup.robot.zoom();
  const double turn_s = servo::slew_time(head.pan_max - head.pan_min, head.rate, head.acceleration);
  const double zoom_s = (zoom.max_zoom_mm() - zoom.min_zoom_mm()) / head.zoom_rate_mm_s;
  return Duration::from_seconds(
      std::max(setup.look.timeout_s, std::max(turn_s, zoom_s) + kSearch_s));
}

}  // namespace

LookScheduler::LookScheduler(const MissionSetup& setup, const InformationModel& information,
                             std::uint64_t seed)
    : setup_(setup),
      information_(information),
      visibility_(visibility(setup)),
      head_model_(head_model(setup)),
      policy_(planner::make_look_policy(
          setup.look.policy,
          {setup.look.fixed_landmark, RandomStream(seed, "look policy"), setup.world.landmarks,
           visibility_, head_model_, setup.look.rules, setup.look.perception})),
      trigger_(setup.look.trigger) {}

void LookScheduler::follow(const Path& path) {
  path_ = &path;
  policy_->follow(path);
}

planner::LookDemand LookScheduler::demand(Stamp now, const Belief& belief, double travelled_m,
                                          double remaining_m) {
  if (!asked_ || now - *asked_ >= Duration::from_seconds(setup_.look.period_s)) {
    asked_ = now;
    last_ = trigger_.demand(belief, travelled_m, remaining_m);
  }
  return last_;
}

std::optional<LookScheduler::Decision> LookScheduler::choose(Stamp now, const Belief& belief,
                                                             const HeadReading& head,
                                                             const Going& going) {
  std::vector<LandmarkId> excluded;
  for (const auto& [landmark, failure] : failures_)
    if (now <= failure.until) excluded.push_back(landmark);

  const auto choice =
      policy_->choose({now, belief, head, going.station_m, *path_, setup_.world.landmarks,
                       visibility_, information_, excluded, head_model_, going.speed_mps,
                       going.standing, setup_.noise.odometry});
  if (!choice) return std::nullopt;
  GazeOrder order;
  order.landmark = choice->landmark;
  order.zoom_mm = choice->zoom_mm;
  order.issued = now;
  order.expires = now + time_for_look(setup_);
  order.dwell_s = setup_.look.dwell_s;
  order.radius_px =
      planner::wanted_radius(*setup_.world.landmarks.find(choice->landmark), head_model_);
  return Decision{order, choice->suitability, choice->reason};
}

std::optional<GazeOrder> LookScheduler::prepare(Stamp now, const Belief& belief,
                                                const HeadReading& head, const Going& going) {
  if (!policy_->prepares()) return std::nullopt;
  if (prepared_ && now - *prepared_ < Duration::from_seconds(setup_.look.period_s)) return waiting_;
  prepared_ = now;
  const auto decision = choose(now, belief, head, going);
  waiting_ = decision ? std::optional(decision->order) : std::nullopt;
  return waiting_;
}

void LookScheduler::failed(Stamp now, LandmarkId landmark) {
  Failure& failure = failures_[landmark];
  const int doublings = std::min(failure.count++, kMostDoublings);
  failure.until = now + Duration::from_seconds(setup_.look.exclude_s * (1 << doublings));
}

void LookScheduler::fused(double travelled_m, LandmarkId landmark) {
  trigger_.looked(travelled_m);
  failures_.erase(landmark);
}

}  // namespace vigia::mission
