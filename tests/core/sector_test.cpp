#include "vigia/core/sector.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"

namespace vigia {
namespace {

/// A hall with a wall across it that leaves a door of 0.7 m; the wall's upper half is lower.
FloorPlan hall_with_door() {
  return FloorPlan({{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}}, 2.8,
                   {{{5.0, 0.0}, {5.0, 2.65}, 2.8}, {{5.0, 3.35}, {5.0, 6.0}, 1.0}}, {});
}

TEST(Sector, MeetsTheNearestPointOfTheFacesInIt) {
  const FloorPlan plan = hall_with_door();
  const auto ahead = [&](double y, double direction, double half_angle, double reach_m) {
    return nearest_face(plan, {4.0, y}, Sector::about(direction, half_angle), reach_m, 0.3);
  };
  // Through the door to the far wall, past a jamb at an angle, onto the wall beside it.
  EXPECT_NEAR(*ahead(3.0, 0.0, from_deg(7.5), 9.0), 6.0, 1e-12);
  EXPECT_NEAR(*ahead(3.0, from_deg(15), from_deg(7.5), 9.0), std::hypot(1.0, 0.35), 1e-12);
  EXPECT_NEAR(*ahead(2.0, 0.0, from_deg(7.5), 9.0), 1.0, 1e-12);
  EXPECT_FALSE(ahead(3.0, 0.0, from_deg(1.0), 2.0));
}

TEST(NearFaces, AreMetByTheRaysThatMeetThePlanWithinReach) {
  const FloorPlan plan = hall_with_door();
  constexpr double kReach_m = 3.5;
  int met = 0;
  int missed = 0;
  for (const Eigen::Vector2d& from : {Eigen::Vector2d(4.0, 3.0), Eigen::Vector2d(5.0, 1.0),
                                      Eigen::Vector2d(9.8, 5.9), Eigen::Vector2d(7.0, 3.0)}) {
    const NearFaces faces(plan, from, kReach_m, 0.3);
    for (int i = 0; i < 97; ++i) {
      const Eigen::Vector2d direction = unit_vector(2.0 * kPi * i / 97.0);
      const auto near = faces.cast(direction, kReach_m);
      const auto all = plan.cast(from, direction, kReach_m, 0.3);
      ASSERT_EQ(near.has_value(), all.has_value());
      ++(near ? met : missed);
      if (!near) continue;
      EXPECT_EQ(near->distance_m, all->distance_m);
      EXPECT_EQ(near->wall, all->wall);
    }
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(missed, 50);
}

TEST(Sector, TurnsByAUnitVector) {
  const Sector turned = Sector::about(0.3, 0.1).turned(unit_vector(1.2));
  const Sector direct = Sector::about(1.5, 0.1);
  EXPECT_LT((turned.right - direct.right).norm(), 1e-15);
  EXPECT_LT((turned.left - direct.left).norm(), 1e-15);
}

TEST(Sector, SeesOverWhatIsLower) {
  const Sector sector = Sector::about(0.0, from_deg(5.0));
  EXPECT_NEAR(*nearest_face(hall_with_door(), {4.0, 5.0}, sector, 9.0, 0.3), 1.0, 1e-12);
  EXPECT_NEAR(*nearest_face(hall_with_door(), {4.0, 5.0}, sector, 9.0, 1.5), 6.0, 1e-12);
}

TEST(Sector, CutsASegmentToWhereAFunctionIsPositive) {
  double low = 0.0;
  double high = 1.0;
  EXPECT_TRUE(keep_positive(-1.0, 3.0, low, high));
  EXPECT_DOUBLE_EQ(low, 0.25);
  EXPECT_TRUE(keep_positive(1.0, -1.0, low, high));
  EXPECT_DOUBLE_EQ(high, 0.5);
  EXPECT_FALSE(keep_positive(-1.0, -2.0, low, high));
  EXPECT_FALSE(keep_positive(1.0, -9.0, low, high));
}

}  // namespace
}  // namespace vigia
