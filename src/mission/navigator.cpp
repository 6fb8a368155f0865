#include "navigator.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace vigia::mission {
namespace {

/// Beyond a point by so much of the path, it lies behind.
constexpr double kBehind_m = 0.3;
/// Times in a drive that a passage is driven at anew after the robot came to stand aside of it.
constexpr int kRealign = 12;

}  // namespace

Navigator::Navigator(const MissionSetup& setup, EventLog& log)
    : setup_(setup),
      log_(log),
      pilot_(setup.path, setup.world.plan, setup.robot.robot.radius_m, setup.robot.robot.base,
             setup.pilot),
      waypoints_(setup.waypoints) {
  for (std::size_t i = 1; i + 1 < waypoints_.size(); ++i)
    vias_.push_back({waypoints_[i], std::numeric_limits<double>::infinity(), {}});
  place_vias();
}

NavigationStep Navigator::step(const pilot::PilotInput& input) {
  const pilot::PilotOutput output = pilot_.step(input);
  NavigationStep step{output.rates, output.activations};
  record(output);
  watch_vias(input.belief.pose);
  if (output.status == pilot::PilotStatus::blocked) go_round(input, output, step);
  if (output.refused) go_elsewhere(input, *output.refused, step);
  return step;
}

void Navigator::record(const pilot::PilotOutput& output) {
  using pilot::PilotStatus;
  if (output.status == PilotStatus::evading && !evading_) {
    evading_ = true;
    Event::Numbers numbers{{"station_m", output.station_m}};
    if (output.obstacle_ahead) {
      numbers.emplace_back("x_m", output.obstacle_ahead->x());
      numbers.emplace_back("y_m", output.obstacle_ahead->y());
    }
    log_.record(EventKind::evade, numbers);
  } else if (output.status == PilotStatus::driving && evading_) {
    evading_ = false;
    log_.record(EventKind::rejoined, {{"station_m", output.station_m}});
  } else if (output.status == PilotStatus::waiting && status_ != PilotStatus::waiting) {
    log_.record(EventKind::wait, {{"station_m", output.station_m}});
  }
  status_ = output.status;
}

void Navigator::place_vias() {
  const Path& path = pilot_.path();
  double station = 0.0;
  for (Via& via : vias_) {
    const bool ahead =
        std::find(waypoints_.begin() + 1, waypoints_.end(), via.at) != waypoints_.end();
    if (ahead) station = path.project(via.at, station, path.length());
    via.station_m = ahead ? std::optional(station) : std::nullopt;
  }
}

/// A point counts as passed when the robot's body has been over it.
void Navigator::watch_vias(const Pose2& here) {
  for (Via& via : vias_) via.nearest_m = std::min(via.nearest_m, (here.position() - via.at).norm());
  auto next = vias_.begin();
  while (next != vias_.end()) {
    const bool passed = next->nearest_m <= setup_.robot.robot.radius_m;
    const bool ahead = next->station_m && pilot_.station() < *next->station_m + kBehind_m;
    if (!passed && ahead && !pilot_.arrived()) break;
    if (!passed)
      log_.record(EventKind::via_missed,
                  {{"x_m", next->at.x()}, {"y_m", next->at.y()}, {"nearest_m", next->nearest_m}});
    next = vias_.erase(next);
  }
}

/// The path stays blocked: another one is planned round what blocks it. Without any, the robot
/// waits and tries again.
void Navigator::go_round(const pilot::PilotInput& input, const pilot::PilotOutput& output,
                         NavigationStep& step) {
  const Pose2& here = input.belief.pose;
  const Eigen::Vector2d where = output.obstacle_ahead.value_or(here.position());
  log_.record(EventKind::blocked,
              {{"x_m", where.x()}, {"y_m", where.y()}, {"for_s", pilot_.stalled_s()}});
  if (pilot_.stalled_s() >= setup_.pilot.avoidance.give_up_s) {
    log_.record(EventKind::stuck, {},
                {{"reason", "the path stays blocked and there is no way round"}});
    step.gave_up = true;
    return;
  }
  blockages_.note(input.now, pilot_.obstacles(here));
  step.replanned = replan(here, "blocked", blockages_.recent(input.now));
}

void Navigator::go_elsewhere(const pilot::PilotInput& input, const pilot::PassageRefusal& refused,
                             NavigationStep& step) {
  const Pose2& here = input.belief.pose;
  if (refused.misaligned && realigned_++ < kRealign && replan(here, "aside of a passage")) {
    step.replanned = true;
    return;
  }
  log_.record(EventKind::refused, {{"x_m", refused.at.x()},
                                   {"y_m", refused.at.y()},
                                   {"width_m", refused.width_m},
                                   {"beside_m", refused.beside_m},
                                   {"sigma_m", refused.sigma_m}});
  std::vector<RoundObstacle> others = blockages_.recent(input.now);
  others.push_back({refused.at, 0.5 * refused.width_m});
  step.replanned = replan(here, "too narrow", others);
  if (step.replanned) return;
  log_.record(EventKind::stuck, {},
              {{"reason", "a passage is too narrow and there is no way round"}});
  step.gave_up = true;
}

bool Navigator::replan(const Pose2& from, const std::string& reason,
                       const std::vector<RoundObstacle>& others) {
  std::vector<Eigen::Vector2d> waypoints{from.position()};
  // The waypoints that still lie ahead on the path that was being followed.
  const Path& path = pilot_.path();
  double station = 0.0;
  for (std::size_t i = 1; i < waypoints_.size(); ++i) {
    station = path.project(waypoints_[i], station, path.length());
    if (station > pilot_.station() || i + 1 == waypoints_.size())
      waypoints.push_back(waypoints_[i]);
  }
  planner::Route route;
  for (;;) {
    route =
        planner::plan_route(setup_.world.plan, waypoints, setup_.route, setup_.route_seed, others);
    // A place to pass by on which something stands is passed by at a distance.
    const bool via_blocked =
        route.status == planner::RouteStatus::goal_blocked && route.leg + 2 < waypoints.size();
    if (!via_blocked) break;
    waypoints.erase(waypoints.begin() + static_cast<std::ptrdiff_t>(route.leg) + 1);
  }
  if (route.status != planner::RouteStatus::found) return false;
  waypoints_ = waypoints;
  pilot_.follow(route.path);
  place_vias();
  log_.record(EventKind::replan, {{"length_m", route.path.length()}}, {{"reason", reason}});
  return true;
}

}  // namespace vigia::mission
