#include "vigia/pilot/pilot.hpp"

#include "hall.hpp"
#include "ring_drive.hpp"

#include <gtest/gtest.h>

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

/// The hall with a wall across it that leaves a door of @p width round y = 3.
FloorPlan hall_with_door(double width) {
  return FloorPlan(
      {{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}}, 2.8,
      {{{5.0, 0.0}, {5.0, 3.0 - 0.5 * width}, 2.8}, {{5.0, 3.0 + 0.5 * width}, {5.0, 6.0}, 2.8}},
      {});
}

/// Along walls at the least distance that a route keeps, round a corner, through a door.
Path along_walls() {
  return Path({{0.42, 5.0}, {0.42, 0.42}, {3.0, 0.42}, {4.0, 3.0}, {9.58, 3.0}, {9.58, 5.58}})
      .resampled(0.05);
}

TEST(Pilot, WithNothingUnknownTheDriveIsThatOfThePathFollowerToTheLastBit) {
  RingDrive seeing(hall_with_door(0.86), along_walls(), {0.42, 5.0, from_deg(-90)});
  RingDrive blind(hall_with_door(0.86), along_walls(), {0.42, 5.0, from_deg(-90)});
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
    drive.people.push_back({{5.0, 3.0 + aside}});
    while (drive.pose.x < 7.5 && drive.seconds < 90.0) drive.tick();
    EXPECT_TRUE(drive.seen.count(PilotStatus::evading)) << aside;
    EXPECT_EQ(drive.output.status, PilotStatus::driving) << aside;
    EXPECT_LT(std::abs(drive.pose.y - 3.0), 0.1) << aside;
    ASSERT_TRUE(drive.run(90.0)) << aside;
    EXPECT_GT(drive.nearest, 0.1) << aside;
    EXPECT_LT(drive.farthest_off, 1.2) << aside;
    EXPECT_FALSE(drive.seen.count(PilotStatus::blocked)) << aside;
  }
}

TEST(Pilot, PassesOnTheSideThatTheKnownWallsLeave) {
  // The wall at y = 2.2 closes the right of the path; round (5, 2.9) only the left is free.
  const FloorPlan plan({{0.0, 2.2}, {10.0, 2.2}, {10.0, 6.0}, {0.0, 6.0}}, 2.8, {}, {});
  RingDrive drive(plan, straight(), {1.0, 3.0, 0.0});
  drive.people.push_back({{5.0, 2.9}});
  double leftmost = 0.0;
  double rightmost = 0.0;
  while (!drive.pilot.arrived() && drive.seconds < 90.0) {
    drive.tick();
    leftmost = std::max(leftmost, drive.pose.y - 3.0);
    rightmost = std::max(rightmost, 3.0 - drive.pose.y);
  }
  EXPECT_TRUE(drive.pilot.arrived());
  EXPECT_GT(drive.nearest, 0.1);
  EXPECT_GT(leftmost, 0.4);
  EXPECT_LT(rightmost, 0.1);
}

TEST(Pilot, LetsSomebodyPassWhoCrossesBeforeIt) {
  for (double start = 0.0; start < 8.0; start += 0.5) {
    RingDrive drive(hall(), straight(), {1.0, 3.0, 0.0});
    // Crosses the path at x = 3.6, before or behind the robot as it happens.
    drive.people.push_back({{3.6, 3.0 + 0.8 * (4.0 + start)}, {0.0, -0.8}});
    ASSERT_TRUE(drive.run(90.0)) << start;
    EXPECT_GT(drive.nearest, 0.1) << start;
    EXPECT_FALSE(drive.seen.count(PilotStatus::blocked)) << start;
  }
}

TEST(Pilot, EvadesSomebodyWhoComesTowardsItOnItsPath) {
  for (const double aside : {-0.2, 0.0, 0.1}) {
    RingDrive drive(hall(), straight(), {1.0, 3.0, 0.0});
    drive.people.push_back({{8.5, 3.0 + aside}, {-0.6, 0.0}});
    ASSERT_TRUE(drive.run(90.0)) << aside;
    EXPECT_GT(drive.nearest, 0.05) << aside;
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
  ASSERT_TRUE(drive.output.obstacle_ahead);
  EXPECT_NEAR(drive.output.obstacle_ahead->x(), 5.1, 0.3);
  EXPECT_NEAR(drive.output.obstacle_ahead->y(), 3.0, 0.6);
  EXPECT_NEAR(drive.pilot.stalled_s(), PilotParams{}.avoidance.blocked_s, 1.0);
  EXPECT_GT(drive.nearest, 0.03);
  drive.unknown_faces = nullptr;
  EXPECT_TRUE(drive.run(drive.seconds + 60.0));
}

TEST(Pilot, KeepsSayingThatItIsBlockedAndCountsFromTheLastProgress) {
  RingDrive drive(hall_with_door(1.2), straight(), {1.0, 3.0, 0.0});
  const FloorPlan door({{-9.0, -9.0}, {20.0, -9.0}, {20.0, 9.0}, {-9.0, 9.0}}, 2.8,
                       {{{5.0, 2.4}, {5.0, 3.6}, 2.0}}, {});
  drive.unknown_faces = &door;
  int said = 0;
  double stalled = 0.0;
  while (drive.seconds < 50.0) {
    drive.tick();
    if (drive.output.status != PilotStatus::blocked) continue;
    ++said;
    EXPECT_GT(drive.pilot.stalled_s(), stalled);
    stalled = drive.pilot.stalled_s();
    // Another path that leads there too is no progress.
    drive.pilot.follow(Path({drive.pose.position(), {9.0, 3.0}}).resampled(0.05));
  }
  EXPECT_GE(said, 3);
}

TEST(Pilot, StandsStillAsOrderedAndGoesOnWhereItWas) {
  RingDrive drive(hall(), straight(), {1.0, 3.0, 0.0});
  while (drive.seconds < 5.0) drive.tick();
  drive.hold = true;
  drive.tick();
  EXPECT_EQ(drive.output.status, PilotStatus::holding);
  EXPECT_EQ(drive.output.activations.hold, 1.0);
  EXPECT_EQ(drive.command.v, 0.0);
  EXPECT_EQ(drive.command.w, 0.0);
  const double station = drive.pilot.station();
  while (drive.seconds < 10.0) drive.tick();
  EXPECT_EQ(drive.pilot.station(), station);
  EXPECT_EQ(drive.pilot.stalled_s(), 0.0);
  drive.hold = false;
  EXPECT_TRUE(drive.run(60.0));
}

TEST(Pilot, StopsBeforeAWallThatStandsWhereTheBeliefHasNone) {
  // The robot is half a metre nearer to the wall at the path's end than it believes.
  RingDrive drive(hall(), Path({{1.0, 3.0}, {9.6, 3.0}}).resampled(0.05), {1.0, 3.0, 0.0});
  drive.belief_error = {-0.5, 0.0, 0.0};
  while (drive.seconds < 60.0) drive.tick();
  EXPECT_GT(drive.nearest, 0.0);
  EXPECT_FALSE(drive.pilot.arrived());
}

TEST(Pilot, TheSameScansGiveTheSameDriveToTheLastBit) {
  RingDrive first(hall(), straight(), {1.0, 3.0, 0.0});
  first.people.push_back({{5.0, 3.1}});
  RingDrive second(hall(), straight(), {1.0, 3.0, 0.0});
  second.people.push_back({{5.0, 3.1}});
  while (first.seconds < 30.0) {
    first.tick();
    second.tick();
    ASSERT_EQ(first.pose.vector(), second.pose.vector());
  }
}

}  // namespace
}  // namespace vigia::pilot
