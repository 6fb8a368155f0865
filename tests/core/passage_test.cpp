#include "vigia/core/passage.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace vigia {
namespace {

/// Two rooms of 4 × 6 m with a door in the middle of the wall between them.
FloorPlan two_rooms(double door_m) {
  return FloorPlan(
      {{0.0, 0.0}, {8.0, 0.0}, {8.0, 6.0}, {0.0, 6.0}}, 2.8,
      {{{4.0, 0.0}, {4.0, 3.0 - 0.5 * door_m}}, {{4.0, 3.0 + 0.5 * door_m}, {4.0, 6.0}}}, {});
}

TEST(Passages, ADoorThatIsCrossedObliquelyIsFoundWithItsWidthAndItsWayThrough) {
  const auto passages = find_passages(two_rooms(0.7), Path({{1.0, 1.0}, {7.0, 5.0}}), 0.42);
  ASSERT_EQ(passages.size(), 1U);
  EXPECT_NEAR(passages[0].width_m, 0.7, 1e-9);
  EXPECT_NEAR((passages[0].middle - Eigen::Vector2d(4.0, 3.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((passages[0].along - Eigen::Vector2d::UnitX()).norm(), 0.0, 1e-9);
  EXPECT_LT(passages[0].begin_m, 0.5 * std::hypot(6.0, 4.0));
  EXPECT_GT(passages[0].end_m, 0.5 * std::hypot(6.0, 4.0));
}

TEST(Passages, ThereIsNoneInAWideDoorNorAlongOneWall) {
  EXPECT_TRUE(find_passages(two_rooms(0.9), Path({{1.0, 1.0}, {7.0, 5.0}}), 0.42).empty());
  EXPECT_TRUE(find_passages(two_rooms(0.7), Path({{1.0, 0.35}, {3.0, 0.35}}), 0.42).empty());
}

TEST(Passages, OneOfSomeLengthIsOne) {
  const FloorPlan corridor({{0.0, 0.0}, {8.0, 0.0}, {8.0, 6.0}, {0.0, 6.0}}, 2.8, {},
                           {{{{3.0, 0.0}, {5.0, 0.0}, {5.0, 2.6}, {3.0, 2.6}}, 2.0},
                            {{{3.0, 3.4}, {5.0, 3.4}, {5.0, 6.0}, {3.0, 6.0}}, 2.0}});
  const auto passages = find_passages(corridor, Path({{1.0, 3.05}, {7.0, 3.05}}), 0.42);
  ASSERT_EQ(passages.size(), 1U);
  EXPECT_NEAR(passages[0].width_m, 0.8, 1e-9);
  EXPECT_NEAR(passages[0].middle.y(), 3.0, 1e-9);
  EXPECT_NEAR(passages[0].begin_m, 2.0, 0.25);
  EXPECT_NEAR(passages[0].end_m, 4.0, 0.25);
}

}  // namespace
}  // namespace vigia
