#include "lanes.hpp"

#include "hall.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

constexpr double kHull = 0.27;

/// Least distance between the hull of a robot on the detour and a thing.
double min_distance(const Detour& detour, const RoundObstacle& thing) {
  const Path path(detour);
  double least = 1e9;
  for (double s = 0.0; s <= path.length(); s += 0.01)
    least = std::min(least, (path.at(s) - thing.centre).norm() - thing.radius_m - kHull);
  return least;
}

TEST(Lanes, WithNothingInTheWayTheWayIsThePath) {
  const FloorPlan plan = hall();
  Lanes lanes(plan, kHull, {});
  const auto detour = lanes.search(straight(), 2.0, {3.0, 3.0}, {}, 0.1);
  ASSERT_TRUE(detour);
  for (const Vector2d& p : *detour) EXPECT_NEAR(p.y(), 3.0, 1e-12);
  EXPECT_NEAR(detour->back().x(), 6.0, 1e-9);
}

TEST(Lanes, KeepItsDistanceFromEveryThing) {
  const FloorPlan plan = hall();
  for (double y = 2.3; y < 3.8; y += 0.1) {
    Lanes lanes(plan, kHull, {});
    const std::vector<RoundObstacle> things{{{4.2, y}, 0.2}, {{5.3, 6.0 - y}, 0.2}};
    const auto detour = lanes.search(straight(), 2.0, {3.0, 3.0}, things, 0.1);
    ASSERT_TRUE(detour) << y;
    for (const RoundObstacle& thing : things)
      EXPECT_GE(min_distance(*detour, thing), 0.07 - 1e-9) << y;
  }
}

TEST(Lanes, KeepClearOfKnownWalls) {
  const FloorPlan plan({{0.0, 2.2}, {10.0, 2.2}, {10.0, 6.0}, {0.0, 6.0}}, 2.8, {}, {});
  Lanes lanes(plan, kHull, {});
  const auto detour = lanes.search(straight(), 2.0, {3.0, 3.0}, {{{4.2, 2.9}, 0.2}}, 0.1);
  ASSERT_TRUE(detour);
  for (const Vector2d& p : *detour)
    EXPECT_GE(plan.clearance(p), kHull + AvoidanceParams{}.wall_m - 1e-9);
}

TEST(Lanes, SayWhenNoneIsFree) {
  const FloorPlan plan({{0.0, 2.2}, {10.0, 2.2}, {10.0, 3.8}, {0.0, 3.8}}, 2.8, {}, {});
  Lanes lanes(plan, kHull, {});
  EXPECT_FALSE(lanes.search(straight(), 2.0, {3.0, 3.0}, {{{4.2, 3.0}, 0.2}}, 0.1));
}

TEST(Lanes, StayOnTheSideThatWasChosenUntilTheyForget) {
  const FloorPlan plan = hall();
  Lanes lanes(plan, kHull, {});
  const auto left_of = [](const Detour& detour) {
    return std::any_of(detour.begin(), detour.end(), [](const Vector2d& p) { return p.y() > 3.2; });
  };
  ASSERT_TRUE(left_of(*lanes.search(straight(), 2.0, {3.0, 3.0}, {{{4.2, 2.9}, 0.2}}, 0.1)));
  EXPECT_TRUE(left_of(*lanes.search(straight(), 2.0, {3.0, 3.0}, {{{4.2, 3.1}, 0.2}}, 0.1)));
  lanes.forget();
  EXPECT_FALSE(left_of(*lanes.search(straight(), 2.0, {3.0, 3.0}, {{{4.2, 3.1}, 0.2}}, 0.1)));
}

TEST(Lanes, AtThePathsEndLeadToTheEndItself) {
  const FloorPlan plan = hall();
  Lanes lanes(plan, kHull, {});
  const auto detour = lanes.search(straight(), 6.5, {7.5, 3.2}, {{{8.0, 3.9}, 0.2}}, 0.1);
  ASSERT_TRUE(detour);
  EXPECT_LT((detour->back() - Vector2d(9.0, 3.0)).norm(), 1e-9);
  EXPECT_FALSE(lanes.search(straight(), 6.5, {7.5, 3.2}, {{{9.1, 3.0}, 0.2}}, 0.1));
}

}  // namespace
}  // namespace vigia::pilot
