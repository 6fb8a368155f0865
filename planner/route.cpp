#include "vigia/planner/route.hpp"

#include "room_to_move.hpp"
#include "route_search.hpp"
#include "straight_passages.hpp"

#include <algorithm>
#include <limits>

#include "vigia/core/random.hpp"
#include "vigia/planner/tight_place.hpp"

namespace vigia::planner {
namespace {

using Eigen::Vector2d;
using Polyline = std::vector<Vector2d>;

constexpr double kRounding = 1e-6;  // m

/// The shortest polyline over vertices of @p points (in their order) that the disc can follow.
Polyline shortcut(const RoomToMove& room, const Polyline& points) {
  const std::size_t n = points.size();
  std::vector<double> cost(n, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> previous(n, 0);
  cost[0] = 0.0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const double via = cost[i] + (points[j] - points[i]).norm();
      if (via < cost[j] && room.passes(points[i], points[j])) {
        cost[j] = via;
        previous[j] = i;
      }
    }
  }
  Polyline result{points.back()};
  for (std::size_t i = n - 1; i != 0; i = previous[i]) result.push_back(points[previous[i]]);
  std::reverse(result.begin(), result.end());
  return result;
}

/// Cuts corners at ever finer subdivisions of the polyline.
Polyline straighten(const RoomToMove& room, Polyline points) {
  for (const double spacing : {0.2, 0.1, 0.05}) {
    points = shortcut(room, Path(points).resampled(spacing).points());
  }
  return points;
}

Polyline plan_between(const RoomToMove& room, const Vector2d& from, const Vector2d& to, int samples,
                      std::uint64_t seed) {
  if (room.passes(from, to)) return {from, to};
  const Polyline found = search_route(room, from, to, samples, seed);
  return found.empty() ? found : straighten(room, found);
}

/// A leg with the disc of @p room. Near an end where the disc does not fit, the leg leaves that end
/// straight for the nearest place where it does.
Polyline plan_leg(const RoomToMove& room, const Vector2d& start, const Vector2d& goal, int samples,
                  std::uint64_t seed) {
  const auto from = room.retreat(start);
  const auto to = room.retreat(goal);
  if (!from || !to) return {};
  Polyline leg = plan_between(room, *from, *to, samples, seed);
  if (leg.empty()) return leg;
  if (*from != start) leg.insert(leg.begin(), start);
  if (*to != goal) leg.push_back(goal);
  return leg;
}

/// Tries the whole clearance first, then less, down to none beyond the robot itself.
Polyline plan_leg_with_fallback(const RoomToMove& body, const Vector2d& start, const Vector2d& goal,
                                const RouteParams& params, std::uint64_t seed) {
  for (const double share : {1.0, 0.5, 0.0}) {
    const RoomToMove room(body.plan(), params.robot_radius_m + share * params.clearance_m,
                          body.others());
    Polyline leg = plan_leg(room, start, goal, params.iterations, seed);
    if (!leg.empty()) return leg;
  }
  return {};
}

/// The obstacles, none of them nearer to @p start than the robot's radius.
std::vector<RoundObstacle> leave_room(std::vector<RoundObstacle> others, const Vector2d& start,
                                      double robot_radius_m) {
  for (RoundObstacle& other : others)
    other.radius_m =
        std::min(other.radius_m, (other.centre - start).norm() - robot_radius_m - kRounding);
  others.erase(std::remove_if(others.begin(), others.end(),
                              [](const RoundObstacle& other) { return other.radius_m <= 0.0; }),
               others.end());
  return others;
}

Route failure(Route route, RouteStatus status, std::size_t leg) {
  route.status = status;
  route.leg = leg;
  return route;
}

}  // namespace

Route plan_route(const FloorPlan& plan, const std::vector<Vector2d>& waypoints,
                 const RouteParams& params, std::uint64_t seed,
                 const std::vector<RoundObstacle>& others) {
  Route route;
  route.waypoints = waypoints;
  const RoomToMove body(plan, params.robot_radius_m,
                        leave_room(others, waypoints.front(), params.robot_radius_m));
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    if (body.fits(waypoints[i])) continue;
    return i == 0 ? failure(route, RouteStatus::start_blocked, 0)
                  : failure(route, RouteStatus::goal_blocked, i - 1);
  }

  Polyline points;
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const LegPlanner plan_between_points = [&](const Vector2d& from, const Vector2d& to) {
      return plan_leg_with_fallback(body, from, to, params, derive_seed(seed, i));
    };
    const Polyline leg =
        with_straight_passages(body, plan_between_points(waypoints[i], waypoints[i + 1]),
                               params.robot_radius_m + params.clearance_m, plan_between_points);
    if (leg.empty()) return failure(route, RouteStatus::no_route, i);
    points.insert(points.end(), leg.begin(), leg.end());
  }
  route.path = Path(points).resampled(params.spacing_m);
  route.status = RouteStatus::found;
  return route;
}

TightPlace tightest_place(const FloorPlan& plan, const Path& path, double robot_radius_m,
                          double ends_m) {
  TightPlace tightest;
  tightest.beside_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < path.points().size(); ++i) {
    const double station = path.stations()[i];
    if (station < ends_m || station > path.length() - ends_m) continue;
    const double beside_m = plan.clearance(path.points()[i]) - robot_radius_m;
    if (beside_m < tightest.beside_m) tightest = {path.points()[i], station, beside_m};
  }
  return tightest;
}

}  // namespace vigia::planner
