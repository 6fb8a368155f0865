#include "vigia/planner/visibility.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace vigia::planner {
namespace {

FloorPlan room(std::vector<Wall> partitions = {}, std::vector<Obstacle> obstacles = {}) {
  return FloorPlan({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8, std::move(partitions),
                   std::move(obstacles));
}

/// A disc on the east wall.
Landmark disc_on_east_wall(double y = 3.5, double z = 1.6) {
  return {1, wall_mount({12.0, y, z}, kPi), DiscShape{0.1}};
}

class VisibilityTest : public ::testing::Test {
 protected:
  Sight sight(const FloorPlan& plan, const Landmark& landmark, const Pose2& pose) const {
    return Visibility(plan, HeadGeometry{}, limits_, VisibilityParams{}).sight(landmark, pose);
  }
  HeadLimits limits_;
};

TEST_F(VisibilityTest, ALandmarkAheadInTheSameRoomIsVisible) {
  EXPECT_EQ(sight(room(), disc_on_east_wall(), {8.0, 3.5, 0.0}), Sight::visible);
  EXPECT_EQ(sight(room(), disc_on_east_wall(), {8.0, 3.5, 2.0}), Sight::visible);
}

TEST_F(VisibilityTest, RangeIsMeasuredFromTheHead) {
  const FloorPlan plan = room();
  const Visibility visibility(plan, HeadGeometry{}, limits_, {});
  // The head sits 0.15 m ahead and 1 m up, the disc 0.6 m higher.
  EXPECT_NEAR(visibility.range(disc_on_east_wall(), {8.0, 3.5, 0.0}), std::hypot(3.85, 0.6), 1e-12);
  EXPECT_NEAR(visibility.range(disc_on_east_wall(), {8.0, 3.5, kPi}), std::hypot(4.15, 0.6), 1e-12);
}

TEST_F(VisibilityTest, ViewAngleIsThatBetweenNormalAndLineOfSight) {
  const FloorPlan plan = room();
  const Visibility visibility(plan, HeadGeometry{}, limits_, {});
  EXPECT_NEAR(visibility.view_angle(disc_on_east_wall(3.5, 1.0), {8.0, 3.5, 0.0}), 0.0, 1e-7);
  EXPECT_NEAR(visibility.view_angle(disc_on_east_wall(6.5, 1.0), {8.85, 3.5, 0.0}), 0.25 * kPi,
              1e-12);
}

TEST_F(VisibilityTest, TooNearTooFarAndTooObliqueAreToldApart) {
  EXPECT_EQ(sight(room(), disc_on_east_wall(3.5, 1.0), {11.4, 3.5, 0.0}), Sight::too_near);
  EXPECT_EQ(sight(room(), disc_on_east_wall(), {1.0, 3.5, 0.0}), Sight::too_far);
  EXPECT_EQ(sight(room(), disc_on_east_wall(6.5), {11.2, 1.0, 0.0}), Sight::too_oblique);
}

TEST_F(VisibilityTest, ALandmarkSeenFromBehindIsTooOblique) {
  const Landmark facing_east{1, wall_mount({6.0, 3.5, 1.6}, 0.0), DiscShape{0.1}};
  EXPECT_EQ(sight(room(), facing_east, {3.0, 3.5, 0.0}), Sight::too_oblique);
}

TEST_F(VisibilityTest, AWallHidesWhatLiesBehindIt) {
  const FloorPlan high = room({{{10.0, 2.0}, {10.0, 5.0}, 2.8}});
  const FloorPlan low = room({{{10.0, 2.0}, {10.0, 5.0}, 0.9}});
  EXPECT_EQ(sight(high, disc_on_east_wall(), {8.0, 3.5, 0.0}), Sight::hidden);
  EXPECT_EQ(sight(low, disc_on_east_wall(), {8.0, 3.5, 0.0}), Sight::visible);
}

TEST_F(VisibilityTest, AnObstacleHidesWhatLiesBehindIt) {
  const FloorPlan plan = room({}, {{{{9.5, 3.0}, {10.0, 3.0}, {10.0, 4.0}, {9.5, 4.0}}, 2.0}});
  EXPECT_EQ(sight(plan, disc_on_east_wall(), {8.0, 3.5, 0.0}), Sight::hidden);
}

TEST_F(VisibilityTest, WhatTheHeadCannotTurnToIsOutOfReach) {
  limits_.pan_min = from_deg(-90.0);
  limits_.pan_max = from_deg(90.0);
  EXPECT_EQ(sight(room(), disc_on_east_wall(), {8.0, 3.5, kPi}), Sight::out_of_reach);
  limits_ = HeadLimits{};
  limits_.tilt_max = from_deg(5.0);
  EXPECT_EQ(sight(room(), disc_on_east_wall(), {8.0, 3.5, 0.0}), Sight::out_of_reach);
}

TEST_F(VisibilityTest, APanRangeThatIsNotSymmetricIsMetOnAnyTurn) {
  limits_.pan_min = 0.0;
  limits_.pan_max = 2.0 * kPi;
  EXPECT_EQ(sight(room(), disc_on_east_wall(), {8.0, 3.5, 0.5 * kPi}), Sight::visible);
}

}  // namespace
}  // namespace vigia::planner
