#include "vigia/core/floor_plan.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"

namespace vigia {
namespace {

/// A 10 × 6 m room of 3 m height with a thin wall at x = 5 up to y = 4 and a low box.
FloorPlan small_room() {
  return {{{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}},
          3.0,
          {{{5.0, 0.0}, {5.0, 4.0}, 2.5}},
          {{{{7.0, 2.0}, {8.0, 2.0}, {8.0, 3.0}, {7.0, 3.0}}, 0.8}}};
}

TEST(FloorPlan, ListsTheFacesOfOutlineThenPartitionsThenObstacles) {
  const FloorPlan plan = small_room();
  ASSERT_EQ(plan.faces().size(), 9U);
  EXPECT_EQ(plan.faces()[0].height_m, 3.0);
  EXPECT_EQ(plan.faces()[4].height_m, 2.5);
  EXPECT_EQ(plan.faces()[5].height_m, 0.8);
  EXPECT_EQ(plan.min_corner(), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(plan.max_corner(), Eigen::Vector2d(10.0, 6.0));
}

TEST(FloorPlan, RejectsFacesWithoutLengthOrHeight) {
  const std::vector<Eigen::Vector2d> outline{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FloorPlan({{0.0, 0.0}, {1.0, 0.0}}, 2.8, {}, {}), std::invalid_argument);
  EXPECT_THROW(FloorPlan(outline, 0.0, {}, {}), std::invalid_argument);
  EXPECT_THROW(FloorPlan(outline, 2.8, {{{0.5, 0.5}, {0.5, 0.5}, 1.0}}, {}), std::invalid_argument);
  EXPECT_THROW(FloorPlan(outline, 2.8, {{{0.5, nan}, {0.6, 0.5}, 1.0}}, {}), std::invalid_argument);
  EXPECT_THROW(FloorPlan(outline, 2.8, {}, {{{{0.1, 0.0}, {0.2, 0.0}}, 1.0}}),
               std::invalid_argument);
}

TEST(FloorPlan, ARayMeetsTheNearestFace) {
  const auto hit = small_room().cast({2.0, 1.0}, {1.0, 0.0}, 20.0);
  ASSERT_TRUE(hit.has_value());
  EXPECT_DOUBLE_EQ(hit->distance_m, 3.0);
  EXPECT_EQ(hit->wall, 4U);
  EXPECT_DOUBLE_EQ(hit->along_m, 1.0);
}

TEST(FloorPlan, ARayPassesOverWhatIsTooLow) {
  const FloorPlan plan = small_room();
  EXPECT_DOUBLE_EQ(plan.cast({6.0, 2.5}, {1.0, 0.0}, 20.0, 0.5)->distance_m, 1.0);
  EXPECT_DOUBLE_EQ(plan.cast({6.0, 2.5}, {1.0, 0.0}, 20.0, 1.0)->distance_m, 4.0);
}

TEST(FloorPlan, ARayThatEndsBeforeAFaceMeetsNothing) {
  EXPECT_FALSE(small_room().cast({2.0, 1.0}, {1.0, 0.0}, 2.9));
}

TEST(FloorPlan, ARayMeetsAWallSeenEdgeOnAtItsNearEnd) {
  const auto hit = small_room().cast({5.0, 5.5}, {0.0, -1.0}, 20.0);
  ASSERT_TRUE(hit.has_value());
  EXPECT_DOUBLE_EQ(hit->distance_m, 1.5);
}

TEST(FloorPlan, NoRayLeavesTheRoomThroughACorner) {
  const FloorPlan plan = small_room();
  RandomStream random(1, "rays");
  for (const Eigen::Vector2d& corner : plan.outline()) {
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector2d origin(random.uniform(0.1, 9.9), random.uniform(0.1, 5.9));
      const Eigen::Vector2d direction = (corner - origin).normalized();
      ASSERT_TRUE(plan.cast(origin, direction, 100.0).has_value()) << origin.transpose();
    }
  }
}

TEST(FloorPlan, ARayFromAWallMeetsItAtOnce) {
  EXPECT_NEAR(small_room().cast({5.0, 1.0}, {1.0, 0.0}, 20.0)->distance_m, 0.0, 1e-9);
}

TEST(FloorPlan, AWallHidesWhatStandsBehindIt) {
  const FloorPlan plan = small_room();
  EXPECT_FALSE(plan.line_of_sight({4.0, 2.0, 1.0}, {6.0, 2.0, 1.0}));
  EXPECT_TRUE(plan.line_of_sight({4.0, 5.0, 1.0}, {6.0, 5.0, 1.0}));
}

TEST(FloorPlan, OneSeesOverALowObstacleAndOverAWall) {
  const FloorPlan plan = small_room();
  EXPECT_TRUE(plan.line_of_sight({6.5, 2.5, 1.0}, {9.0, 2.5, 1.0}));
  EXPECT_FALSE(plan.line_of_sight({6.5, 2.5, 1.0}, {9.0, 2.5, 0.2}));
  EXPECT_FALSE(plan.line_of_sight({6.5, 2.5, 0.3}, {9.0, 2.5, 0.3}));
  EXPECT_TRUE(plan.line_of_sight({4.0, 2.0, 2.6}, {6.0, 2.0, 2.6}));
}

TEST(FloorPlan, ALineThatComesDownOnAnObstacleIsHiddenByItsFarSide) {
  // Above the near side (x = 7), below the far one (x = 8).
  EXPECT_FALSE(small_room().line_of_sight({6.0, 2.5, 1.4}, {9.0, 2.5, 0.0}));
}

TEST(FloorPlan, ALandmarkIsNotHiddenByTheFaceItLiesOn) {
  const FloorPlan plan = small_room();
  const Eigen::Vector3d eye(2.0, 3.0, 1.0);
  for (const double off : {0.0, 0.0009, -0.0009}) {
    EXPECT_TRUE(plan.line_of_sight(eye, {5.0 + off, 2.0, 1.5})) << off;
    EXPECT_TRUE(plan.line_of_sight({5.0 + off, 2.0, 1.5}, eye)) << off;
    EXPECT_TRUE(plan.line_of_sight(eye, {0.0 + off, 2.0, 1.5})) << off;
  }
  EXPECT_FALSE(plan.line_of_sight(eye, {5.0011, 2.0, 1.5}));
}

TEST(FloorPlan, ALandmarkOnTheFarSideOfAnObstacleIsHidden) {
  EXPECT_FALSE(small_room().line_of_sight({6.0, 2.5, 0.4}, {8.0, 2.5, 0.4}));
  EXPECT_TRUE(small_room().line_of_sight({6.0, 2.5, 0.4}, {7.0, 2.5, 0.4}));
}

TEST(FloorPlan, SightIsTheSameInBothDirections) {
  const FloorPlan plan = small_room();
  RandomStream random(2, "sight");
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d p(random.uniform(0.0, 10.0), random.uniform(0.0, 6.0),
                            random.uniform(0.0, 3.0));
    const Eigen::Vector3d q(random.uniform(0.0, 10.0), random.uniform(0.0, 6.0),
                            random.uniform(0.0, 3.0));
    ASSERT_EQ(plan.line_of_sight(p, q), plan.line_of_sight(q, p));
  }
}

TEST(FloorPlan, SightAgreesWithACastRayAtOneHeight) {
  const FloorPlan plan = small_room();
  RandomStream random(3, "sight");
  constexpr double kEye = 1.0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2d p(random.uniform(0.1, 9.9), random.uniform(0.1, 5.9));
    const Eigen::Vector2d q(random.uniform(0.1, 9.9), random.uniform(0.1, 5.9));
    if (std::abs(p.x() - 5.0) < 0.01 || std::abs(q.x() - 5.0) < 0.01) continue;
    const Eigen::Vector2d gap = q - p;
    const bool free = !plan.cast(p, gap.normalized(), gap.norm(), kEye).has_value();
    ASSERT_EQ(plan.line_of_sight({p.x(), p.y(), kEye}, {q.x(), q.y(), kEye}), free);
  }
}

TEST(FloorPlan, ClearanceIsTheDistanceToTheNearestFace) {
  const FloorPlan plan = small_room();
  EXPECT_DOUBLE_EQ(plan.clearance({2.0, 1.5}), 1.5);
  EXPECT_NEAR(plan.clearance({4.6, 3.0}), 0.4, 1e-12);
  EXPECT_NEAR(plan.clearance({5.3, 4.4}), 0.5, 1e-12);
}

TEST(FloorPlan, ClearanceIsNegativeInsideAnObstacleAndOutsideTheRoom) {
  const FloorPlan plan = small_room();
  EXPECT_NEAR(plan.clearance({7.3, 2.5}), -0.3, 1e-12);
  EXPECT_DOUBLE_EQ(plan.clearance({-1.0, 3.0}), -1.0);
}

TEST(FloorPlan, WithoutFacesEverythingIsFree) {
  const FloorPlan nothing;
  EXPECT_TRUE(std::isinf(nothing.clearance({0.0, 0.0})));
  EXPECT_FALSE(nothing.cast({0.0, 0.0}, {1.0, 0.0}, 10.0));
  EXPECT_TRUE(nothing.line_of_sight({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}));
}

}  // namespace
}  // namespace vigia
