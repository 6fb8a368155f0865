#include "vigia/planner/route.hpp"

#include "room_to_move.hpp"

#include <cmath>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <ompl/util/RandomNumbers.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"
#include "vigia/planner/tight_place.hpp"

namespace vigia::planner {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

const Points kOutline{{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}};

/// The 12×7 m room with two partitions, a table and a triangular pillar.
FloorPlan furnished_room() {
  return FloorPlan(kOutline, 2.8, {{{4.0, 0.0}, {4.0, 4.5}, 2.8}, {{8.0, 7.0}, {8.0, 2.5}, 2.8}},
                   {{{{5.5, 3.0}, {6.5, 3.0}, {6.5, 4.0}, {5.5, 4.0}}, 0.8},
                    {{{10.0, 2.0}, {10.6, 2.2}, {10.2, 2.7}}, 2.0}});
}

/// Least distance of the path from every face, exactly.
double path_clearance(const FloorPlan& plan, const Path& path) {
  double least = 1e9;
  for (std::size_t i = 1; i < path.points().size(); ++i) {
    for (const Wall& face : plan.faces())
      least =
          std::min(least, segment_distance(path.points()[i - 1], path.points()[i], face.a, face.b));
  }
  return least;
}

Route route_in(const FloorPlan& plan, const Points& waypoints, std::uint64_t seed = 1) {
  return plan_route(plan, waypoints, RouteParams{}, seed);
}

TEST(Route, AFreeLegIsStraight) {
  const Route route = route_in(FloorPlan(kOutline, 2.8, {}, {}), {{1.0, 1.0}, {10.0, 6.0}});
  ASSERT_EQ(route.status, RouteStatus::found);
  EXPECT_NEAR(route.path.length(), std::hypot(9.0, 5.0), 1e-9);
}

TEST(Route, KeepsTheWholeClearanceWhereThereIsRoom) {
  const FloorPlan plan = furnished_room();
  const Route route = route_in(plan, {{1.0, 1.0}, {6.0, 6.0}, {11.0, 6.0}, {11.0, 1.0}});
  ASSERT_EQ(route.status, RouteStatus::found);
  EXPECT_GE(path_clearance(plan, route.path), 0.45 - 1e-9);
}

TEST(Route, TheTightestPlaceIsTheDoor) {
  // A door of 0.8 m.
  const FloorPlan plan(kOutline, 2.8,
                       {{{6.0, 0.0}, {6.0, 3.0}, 2.8}, {{6.0, 3.8}, {6.0, 7.0}, 2.8}}, {});
  const Route route = route_in(plan, {{2.0, 3.4}, {10.0, 3.4}});
  ASSERT_EQ(route.status, RouteStatus::found);
  const TightPlace door = tightest_place(plan, route.path, RouteParams{}.robot_radius_m);
  EXPECT_NEAR(door.at.x(), 6.0, 0.05);
  EXPECT_NEAR(door.station_m, 4.0, 0.05);
  EXPECT_NEAR(door.beside_m, 0.1, 0.005);
}

TEST(Route, BeginsAtTheStartPassesTheViasAndEndsAtTheGoal) {
  const Points waypoints{{1.0, 1.0}, {6.0, 6.0}, {11.0, 6.0}};
  const Route route = route_in(furnished_room(), waypoints);
  ASSERT_EQ(route.status, RouteStatus::found);
  EXPECT_EQ(route.path.points().front(), waypoints.front());
  EXPECT_EQ(route.path.points().back(), waypoints.back());
  const double station = route.path.project(waypoints[1], 0.0, route.path.length());
  EXPECT_NEAR((route.path.at(station) - waypoints[1]).norm(), 0.0, 1e-9);
}

TEST(Route, IsSampledAtItsSpacing) {
  const Route route = route_in(furnished_room(), {{1.0, 1.0}, {11.0, 6.0}});
  ASSERT_EQ(route.status, RouteStatus::found);
  for (std::size_t i = 1; i < route.path.stations().size(); ++i)
    EXPECT_LE(route.path.stations()[i] - route.path.stations()[i - 1], 0.05 + 1e-9);
}

TEST(Route, IsHardlyLongerThanTheShortestOne) {
  // Round the end of one partition: straight to its clearance circle, along it, straight on.
  const FloorPlan plan(kOutline, 2.8, {{{6.0, 0.0}, {6.0, 5.0}, 2.8}}, {});
  const Vector2d end(6.0, 5.0);
  const Vector2d start(3.0, 2.0);
  const Vector2d goal(9.0, 2.0);
  const double r = 0.45;
  const double d = (start - end).norm();
  const double tangent = std::sqrt(d * d - r * r);
  // Start and goal lie three quarters of a turn apart, seen from the end; each tangent point lies
  // acos(r/d) from its own.
  const double span = 1.5 * kPi - 2.0 * std::acos(r / d);
  const double shortest = 2.0 * tangent + r * span;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Route route = route_in(plan, {start, goal}, seed);
    ASSERT_EQ(route.status, RouteStatus::found);
    EXPECT_GE(route.path.length(), shortest - 1e-6);
    EXPECT_LE(route.path.length(), 1.01 * shortest);
  }
}

TEST(Route, PassesADoorThatLeavesLessThanTheClearance) {
  // 0.74 m: 7 cm beyond the robot on each side where 15 cm are wanted.
  const FloorPlan plan(kOutline, 2.8,
                       {{{6.0, 0.0}, {6.0, 3.0}, 2.8}, {{6.0, 3.74}, {6.0, 7.0}, 2.8}}, {});
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Route route = route_in(plan, {{1.0, 1.0}, {11.0, 6.0}}, seed);
    ASSERT_EQ(route.status, RouteStatus::found);
    EXPECT_GE(path_clearance(plan, route.path), 0.3 - 1e-9);
  }
}

TEST(Route, GoesStraightThroughTheMiddleOfANarrowDoor) {
  for (const double width : {0.66, 0.75, 0.85}) {
    const FloorPlan plan(
        kOutline, 2.8,
        {{{6.0, 0.0}, {6.0, 3.0 - 0.5 * width}, 2.8}, {{6.0, 3.0 + 0.5 * width}, {6.0, 7.0}, 2.8}},
        {});
    const Route route = route_in(plan, {{2.0, 0.6}, {10.0, 5.4}});
    ASSERT_EQ(route.status, RouteStatus::found);
    EXPECT_NEAR(path_clearance(plan, route.path), 0.5 * width, 1e-6) << width;
    for (const Vector2d& p : route.path.points())
      EXPECT_TRUE(std::abs(p.x() - 6.0) > 0.5 || std::abs(p.y() - 3.0) < 1e-6)
          << width << ", " << p.x();
  }
}

TEST(Route, StartsAndEndsNearAWallButSoonKeepsTheClearance) {
  const FloorPlan plan(kOutline, 2.8, {}, {});
  const Route route = route_in(plan, {{0.35, 1.0}, {0.35, 6.0}});
  ASSERT_EQ(route.status, RouteStatus::found);
  EXPECT_GE(path_clearance(plan, route.path), 0.35 - 1e-9);
  EXPECT_GE(plan.clearance(route.path.at(0.5 * route.path.length())), 0.45 - 1e-9);
}

TEST(Route, ABlockedStartOrGoalIsNamed) {
  const FloorPlan plan = furnished_room();
  EXPECT_EQ(route_in(plan, {{0.2, 1.0}, {3.0, 1.0}}).status, RouteStatus::start_blocked);
  EXPECT_EQ(route_in(plan, {{6.0, 3.5}, {3.0, 1.0}}).status, RouteStatus::start_blocked);
  const Route route = route_in(plan, {{1.0, 1.0}, {3.0, 1.0}, {6.0, 3.5}});
  EXPECT_EQ(route.status, RouteStatus::goal_blocked);
  EXPECT_EQ(route.leg, 1U);
  EXPECT_EQ(route_in(plan, {{1.0, 1.0}, {15.0, 1.0}}).status, RouteStatus::goal_blocked);
}

TEST(Route, ARoomWithoutADoorHasNoRoute) {
  const FloorPlan plan(kOutline, 2.8, {{{6.0, 0.0}, {6.0, 7.0}, 2.8}}, {});
  const Route route = route_in(plan, {{1.0, 1.0}, {3.0, 1.0}, {11.0, 1.0}});
  EXPECT_EQ(route.status, RouteStatus::no_route);
  EXPECT_EQ(route.leg, 1U);
}

TEST(Route, ADoorNarrowerThanTheRobotIsNoRoute) {
  const FloorPlan plan(kOutline, 2.8,
                       {{{6.0, 0.0}, {6.0, 3.0}, 2.8}, {{6.0, 3.59}, {6.0, 7.0}, 2.8}}, {});
  EXPECT_EQ(route_in(plan, {{1.0, 1.0}, {11.0, 1.0}}).status, RouteStatus::no_route);
}

/// Least distance of the path from an obstacle's surface.
double distance_to(const RoundObstacle& obstacle, const Path& path) {
  double least = 1e9;
  for (std::size_t i = 1; i < path.points().size(); ++i)
    least = std::min(least, segment_distance(path.points()[i - 1], path.points()[i],
                                             obstacle.centre, obstacle.centre) -
                                obstacle.radius_m);
  return least;
}

TEST(Route, GoesRoundWhatStandsInItsWay) {
  const FloorPlan plan = furnished_room();
  const std::vector<RoundObstacle> others{{{2.0, 4.8}, 0.3}, {{3.1, 3.0}, 0.2}, {{6.0, 5.8}, 0.25}};
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Route route =
        plan_route(plan, {{1.0, 1.0}, {6.0, 6.6}, {11.0, 6.0}}, RouteParams{}, seed, others);
    ASSERT_EQ(route.status, RouteStatus::found) << "seed " << seed;
    for (const RoundObstacle& other : others)
      EXPECT_GE(distance_to(other, route.path), 0.3 - 1e-9) << "seed " << seed;
    EXPECT_GE(path_clearance(plan, route.path), 0.3 - 1e-9) << "seed " << seed;
  }
}

TEST(Route, KeepsTheWholeClearanceFromAnObstacleInTheOpen) {
  const FloorPlan plan(kOutline, 2.8, {}, {});
  const RoundObstacle other{{5.0, 3.5}, 0.4};
  const Route route = plan_route(plan, {{1.0, 3.5}, {10.0, 3.5}}, RouteParams{}, 1, {other});
  ASSERT_EQ(route.status, RouteStatus::found);
  EXPECT_GE(distance_to(other, route.path), 0.45 - 1e-9);
  // Not much longer than the straight line: round a circle of 0.85 m.
  EXPECT_LE(route.path.length(), 9.3);
}

TEST(Route, AnObstacleInTheOnlyDoorIsNoRoute) {
  const FloorPlan plan(kOutline, 2.8,
                       {{{6.0, 0.0}, {6.0, 3.0}, 2.8}, {{6.0, 4.2}, {6.0, 7.0}, 2.8}}, {});
  const Points waypoints{{1.0, 1.0}, {11.0, 6.0}};
  EXPECT_EQ(plan_route(plan, waypoints, RouteParams{}, 1).status, RouteStatus::found);
  EXPECT_EQ(plan_route(plan, waypoints, RouteParams{}, 1, {{{6.0, 3.6}, 0.3}}).status,
            RouteStatus::no_route);
}

TEST(Route, AnObstacleOnTheGoalIsNamed) {
  const Route route = plan_route(FloorPlan(kOutline, 2.8, {}, {}), {{1.0, 1.0}, {9.0, 5.0}},
                                 RouteParams{}, 1, {{{9.2, 5.0}, 0.3}});
  EXPECT_EQ(route.status, RouteStatus::goal_blocked);
  EXPECT_EQ(route.leg, 0U);
}

TEST(Route, AnObstacleThatReachesIntoTheRobotAtItsStartLeavesItRoomThere) {
  const RoundObstacle other{{1.5, 1.0}, 0.4};
  const Route route = plan_route(FloorPlan(kOutline, 2.8, {}, {}), {{1.0, 1.0}, {9.0, 1.0}},
                                 RouteParams{}, 1, {other});
  ASSERT_EQ(route.status, RouteStatus::found);
  EXPECT_GE(distance_to({other.centre, 0.2}, route.path), 0.3 - 1e-5);
}

TEST(Route, TheSameSeedGivesTheSameBytesWhateverElseUsesOmpl) {
  const FloorPlan plan = furnished_room();
  const Points waypoints{{1.0, 1.0}, {11.0, 6.0}, {1.0, 6.0}};
  const Route first = route_in(plan, waypoints, 3);
  ompl::RNG other;
  EXPECT_GE(other.uniform01(), 0.0);
  route_in(plan, waypoints, 4);
  const Route second = route_in(plan, waypoints, 3);
  EXPECT_EQ(first.path.points(), second.path.points());
}

TEST(Route, TheSameSeedGivesTheSameBytesOnSeveralThreads) {
  const FloorPlan plan = furnished_room();
  const Points waypoints{{1.0, 1.0}, {11.0, 6.0}};
  std::vector<Route> alone;
  for (std::uint64_t seed = 0; seed < 4; ++seed) alone.push_back(route_in(plan, waypoints, seed));
  std::vector<Route> together(4);
  std::vector<std::thread> threads;
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    threads.emplace_back([&, seed] { together[seed] = route_in(plan, waypoints, seed); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < alone.size(); ++i)
    EXPECT_EQ(alone[i].path.points(), together[i].path.points());
}

TEST(Route, DifferentSeedsMayDifferButAllArrive) {
  const FloorPlan plan = furnished_room();
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Route route = route_in(plan, {{1.0, 1.0}, {11.0, 6.0}}, seed);
    ASSERT_EQ(route.status, RouteStatus::found) << "seed " << seed;
    EXPECT_GE(path_clearance(plan, route.path), 0.45 - 1e-9) << "seed " << seed;
  }
}

}  // namespace
}  // namespace vigia::planner
