#include "loop.hpp"

namespace vigia::mission {

BaseRates Loop::drive() {
  const RangeScan scan = simulator_.scan();
  const pilot::PilotOutput output = pilot_.step(
      {now_, odometry_, belief(), scan.readings.empty() ? nullptr : &scan, stopped_to_look_});
  activations_ = output.activations;
  tell_pilot(output);
  if (output.status == pilot::PilotStatus::blocked) go_round(output);
  return output.rates;
}

void Loop::tell_pilot(const pilot::PilotOutput& output) {
  using pilot::PilotStatus;
  if (output.status == PilotStatus::evading && !evading_) {
    evading_ = true;
    Numbers numbers{{"station_m", output.station_m}};
    if (output.obstacle_ahead) {
      numbers.emplace_back("x_m", output.obstacle_ahead->x());
      numbers.emplace_back("y_m", output.obstacle_ahead->y());
    }
    tell("evade", numbers);
  } else if (output.status == PilotStatus::driving && evading_) {
    evading_ = false;
    tell("rejoined", {{"station_m", output.station_m}});
  } else if (output.status == PilotStatus::waiting && pilot_status_ != PilotStatus::waiting) {
    tell("wait", {{"station_m", output.station_m}});
  }
  pilot_status_ = output.status;
}

/// The path stays blocked: another one is planned round what blocks it. Without any, the robot
/// waits and tries again.
void Loop::go_round(const pilot::PilotOutput& output) {
  const Eigen::Vector2d where = output.obstacle_ahead.value_or(belief().pose.position());
  tell("blocked", {{"x_m", where.x()}, {"y_m", where.y()}, {"for_s", pilot_.stalled_s()}});
  if (pilot_.stalled_s() >= setup_.pilot.avoidance.give_up_s) {
    tell("stuck", {}, {{"reason", "the path stays blocked and there is no way round"}});
    gave_up_ = Outcome::stuck;
    return;
  }
  blockages_.note(now_, pilot_.obstacles(belief().pose));
  replan(belief().pose, "blocked", blockages_.recent(now_));
}

bool Loop::replan(const Pose2& from, const std::string& reason,
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
  scheduler_.follow(pilot_.path());
  tell("replan", {{"length_m", route.path.length()}}, {{"reason", reason}});
  return true;
}

}  // namespace vigia::mission
