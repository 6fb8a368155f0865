#include "vigia/pilot/pilot.hpp"

#include "ring_drive.hpp"

#include <gtest/gtest.h>

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

FloorPlan hall() {
  return FloorPlan({{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}}, 2.8, {}, {});
}

/// The hall with a wall across it that leaves a door of @p width round y = 3.
FloorPlan hall_with_door(double width) {
  return FloorPlan(
      {{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}}, 2.8,
      {{{5.0, 0.0}, {5.0, 3.0 - 0.5 * width}, 2.8}, {{5.0, 3.0 + 0.5 * width}, {5.0, 6.0}, 2.8}},
      {});
}

Path straight() {
  return Path({{1.0, 3.0}, {9.0, 3.0}}).resampled(0.05);
}

/// Along walls at the least distance that a route keeps, round a corner, through a door.
Path along_walls() {
  return Path({{0.42, 5.0}, {0.42, 0.42}, {3.0, 0.42}, {4.0, 3.0}, {9.58, 3.0}, {9.58, 5.58}})
      .resampled(0.05);
}

TEST(Pilot, WithNothingUnknownTheDriveIsThatOfThePathFollowerToTheLastBit) {
  RingDrive seeing(hall_with_door(0.74), along_walls(), {0.42, 5.0, from_deg(-90)});
  RingDrive blind(hall_with_door(0.74), along_walls(), {0.42, 5.0, from_deg(-90)});
  blind.ring = false;
  // As wrong as a belief of this covariance (2 cm, 0.6°) is on a bad day.
  seeing.belief_error = blind.belief_error = {0.03, -0.03, from_deg(1.0)};
  PathFollower follower(along_walls(), blind.limits, {});
  while (!blind.pilot.arrived() && blind.seconds < 120.0) {
    seeing.tick();
    blind.tick();
    const BaseRates alone = follower.step(blind.belief.pose);
    ASSERT_EQ(seeing.command.v, alone.v) << blind.seconds << " s";
    ASSERT_EQ(seeing.command.w, alone.w) << blind.seconds << " s";
    ASSERT_EQ(blind.command.v, alone.v);
    ASSERT_EQ(blind.command.w, alone.w);
  }
  EXPECT_TRUE(seeing.pilot.arrived());
  EXPECT_EQ(seeing.seen, (std::set<PilotStatus>{PilotStatus::driving, PilotStatus::arrived}));
}

TEST(Pilot, DrivesRoundSomebodyWhoStandsInThePathAndRejoinsIt) {
  for (const double aside : {-0.3, -0.1, 0.0, 0.2, 0.4}) {
    RingDrive drive(hall(), straight(), {1.0, 3.0, 0.0});
    drive.people.push_back(standing_at({5.0, 3.0 + aside}));
    ASSERT_TRUE(drive.run(90.0)) << aside;
    EXPECT_GT(drive.nearest, 0.03) << aside;
    EXPECT_LT(drive.farthest_off, 1.3) << aside;
    EXPECT_TRUE(drive.seen.count(PilotStatus::evading)) << aside;
    EXPECT_FALSE(drive.seen.count(PilotStatus::blocked)) << aside;
    std::printf("aside %.1f nearest %.3f off %.3f  t %.1f\n", aside, drive.nearest,
                drive.farthest_off, drive.seconds);
  }
}

TEST(Pilot, LetsSomebodyPassWithoutLeavingThePath) {
  for (double start = 0.0; start < 6.0; start += 0.7) {
    RingDrive drive(hall(), straight(), {1.0, 3.0, 0.0});
    // Crosses at 1 m/s in front of the robot; the robot is at x = 3 after about 7 s.
    drive.people.push_back(
        {[start](double t) { return Vector2d(3.6, 6.0 - 1.0 * (t - 4.0 - start)); }});
    ASSERT_TRUE(drive.run(90.0)) << start;
    std::printf("start %.1f nearest %.3f off %.3f  t %.1f\n", start, drive.nearest,
                drive.farthest_off, drive.seconds);
    EXPECT_LT(drive.farthest_off, 0.1) << start;
  }
}

TEST(Pilot, AClosedDoorIsBlockedWithItsPlaceAndAnOpenedOneIsDriven) {
  RingDrive drive(hall_with_door(1.2), straight(), {1.0, 3.0, 0.0});
  const FloorPlan door({{-9.0, -9.0}, {20.0, -9.0}, {20.0, 9.0}, {-9.0, 9.0}}, 2.8,
                       {{{5.0, 2.4}, {5.0, 3.6}, 2.0}}, {});
  drive.unknown_faces = &door;
  while (drive.output.status != PilotStatus::blocked && drive.seconds < 60.0) drive.tick();
  ASSERT_EQ(drive.output.status, PilotStatus::blocked);
  EXPECT_LT(drive.pose.x, 5.0 - RingDrive::kRadius);
  ASSERT_TRUE(drive.output.in_the_way);
  EXPECT_NEAR(drive.output.in_the_way->x(), 5.1, 0.3);
  EXPECT_NEAR(drive.output.in_the_way->y(), 3.0, 0.6);
  EXPECT_NEAR(drive.pilot.stalled_s(), PilotParams{}.avoidance.blocked_s, 1.0);
  EXPECT_GT(drive.nearest, 0.03);
  drive.unknown_faces = nullptr;
  EXPECT_TRUE(drive.run(drive.seconds + 60.0));
}

}  // namespace
}  // namespace vigia::pilot
