#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/round_obstacle.hpp"

namespace vigia::planner {

struct RouteParams {
  double robot_radius_m = 0.3;
  double clearance_m = 0.15;  ///< kept beyond the robot's radius where the building allows
  int iterations = 1000;      ///< states that the planner samples per leg: never the clock
  double spacing_m = 0.05;    ///< of the resampled path
};

enum class RouteStatus { found, start_blocked, goal_blocked, no_route };

struct Route {
  RouteStatus status = RouteStatus::no_route;
  std::size_t leg = 0;  ///< which leg failed, when one did
  Path path;
  std::vector<Eigen::Vector2d> waypoints;  ///< start, vias, goal
};

/// A route through @p waypoints (start, vias, goal) that keeps robot_radius_m + clearance_m from
/// every face and every one of @p others (obstacles that the plan does not have),
/// planned leg by leg with OMPL; the same seed gives the same route. Others that reach into the
/// robot at its start count as far as they leave it room: where the robot stands, nothing else is.
Route plan_route(const FloorPlan& plan, const std::vector<Eigen::Vector2d>& waypoints,
                 const RouteParams& params, std::uint64_t seed,
                 const std::vector<RoundObstacle>& others = {});

}  // namespace vigia::planner
