#include "echo_memory.hpp"
#include "known_walls.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

FloorPlan room() {
  return FloorPlan({{0, 0}, {10, 0}, {10, 6}, {0, 6}}, 2.8, {{{5, 0}, {5, 2}, 2.8}}, {});
}

bool wall_echo(const Pose2& base, double bearing_deg, double range_m, const PoseDoubt& doubt = {}) {
  return explained({from_deg(bearing_deg), range_m, true}, room(), base, doubt, from_deg(7.5),
                   0.02);
}

TEST(KnownWalls, ExplainAnEchoAtTheirDistanceAndNoneBeforeThem) {
  const Pose2 base{2.0, 3.0, 0.0};
  EXPECT_TRUE(wall_echo(base, 180, 2.0));
  EXPECT_TRUE(wall_echo(base, 180, 1.93));
  EXPECT_FALSE(wall_echo(base, 180, 1.9));
  EXPECT_FALSE(wall_echo(base, 0, 2.0));
}

TEST(KnownWalls, ExplainWhatAWideBeamHearsAtItsEdge) {
  // Along the wall y = 0 at 0.42 m, the beam at 15° downwards hears the wall under 22.5°.
  const Pose2 base{3.0, 0.42, 0.0};
  EXPECT_TRUE(wall_echo(base, -15, 0.42 / std::sin(from_deg(22.5))));
  EXPECT_FALSE(wall_echo(base, -15, 0.42 / std::sin(from_deg(35))));
}

TEST(KnownWalls, ADoubtfulBeliefLetsThemExplainMore) {
  const Pose2 base{2.0, 3.0, 0.0};
  EXPECT_FALSE(wall_echo(base, 180, 1.8));
  EXPECT_TRUE(wall_echo(base, 180, 1.8, {0.06, 0.0}));
  // The end of the partition, 20° beside the beam.
  const Pose2 near{4.0, 2.36, 0.0};
  const double range = std::hypot(1.0, 0.36);
  EXPECT_FALSE(wall_echo(near, 0, range));
  EXPECT_TRUE(wall_echo(near, 0, range, {0.0, from_deg(4)}));
}

TEST(KnownWalls, ExplainEveryTrueEchoOfARoomForABeliefAsGoodAsItSays) {
  const FloorPlan plan = room();
  RandomStream random(5, "poses");
  const PoseDoubt doubt{0.03, from_deg(0.5)};
  int echoes = 0;
  int missed = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose2 pose{random.uniform(0.4, 4.6), random.uniform(0.4, 5.6), random.uniform(-3.0, 3.0)};
    const Pose2 believed{pose.x + doubt.position_m * random.normal(),
                         pose.y + doubt.position_m * random.normal(),
                         pose.theta + doubt.heading * random.normal()};
    for (int beam = 0; beam < 24; ++beam) {
      const double bearing = from_deg(15.0 * beam);
      double range = 1e9;
      for (int ray = -10; ray <= 10; ++ray) {
        const double angle = pose.theta + bearing + from_deg(0.75 * ray);
        const auto hit = plan.cast(pose.position(), {std::cos(angle), std::sin(angle)}, 20.0);
        ASSERT_TRUE(hit);
        range = std::min(range, hit->distance_m);
      }
      range += 0.02 * random.normal();
      ++echoes;
      if (!explained({bearing, range, true}, plan, believed, doubt, from_deg(7.5), 0.02)) ++missed;
    }
  }
  // Beyond four standard deviations lie 6e-5 of a normal variable: 0.3 of 4,800 echoes, and the
  // chance of more than five is 1e-5.
  EXPECT_EQ(echoes, 4800);
  EXPECT_LE(missed, 5);
}

RangeScan scan_of(double seconds, int beam, double range_m) {
  RangeScan scan{Stamp::from_seconds(seconds), 4.0, {}};
  for (int i = 0; i < 24; ++i)
    scan.readings.push_back({wrap_angle(from_deg(15.0 * i)), i == beam ? range_m : 4.0, i == beam});
  return scan;
}

std::vector<char> only(int beam) {
  std::vector<char> marks(24, 0);
  if (beam >= 0) marks[static_cast<std::size_t>(beam)] = 1;
  return marks;
}

TEST(EchoMemory, AThingCountsOnceEnoughScansShowIt) {
  EchoMemory memory{RingParams{}};
  for (int i = 0; i < 3; ++i) {
    if (i > 0) {
      EXPECT_FALSE(memory.confirmed(memory.echoes().front()));
    }
    memory.take(scan_of(0.04 * i, 2, 1.5), only(2));
    ASSERT_EQ(memory.echoes().size(), 1U);
  }
  EXPECT_TRUE(memory.confirmed(memory.echoes().front()));
}

TEST(EchoMemory, ASingleSlipOfTheRingIsForgottenAtOnce) {
  EchoMemory memory{RingParams{}};
  memory.take(scan_of(0.0, 2, 1.5), only(2));
  memory.take(scan_of(0.04, 2, 1.9), only(-1));
  EXPECT_TRUE(memory.echoes().empty());
}

TEST(EchoMemory, SomebodyWhoWentAwayIsForgottenWithinAQuarterOfASecond) {
  EchoMemory memory{RingParams{}};
  double now = 0.0;
  for (int i = 0; i < 50; ++i, now += 0.04) memory.take(scan_of(now, 2, 1.5), only(2));
  const double gone = now;
  while (!memory.echoes().empty() && now < 10.0) {
    memory.take(scan_of(now, -1, 4.0), only(-1));
    now += 0.04;
  }
  EXPECT_LE(now - gone, 0.25);
}

TEST(EchoMemory, WhatIsHiddenIsKeptAsLongAsSaidAndNoLonger) {
  EchoMemory memory{RingParams{}};
  for (int i = 0; i < 5; ++i) memory.take(scan_of(0.04 * i, 2, 1.5), only(2));
  // Something nearer stands before it now.
  memory.take(scan_of(1.0, 2, 0.5), only(-1));
  memory.forget(Stamp::from_seconds(3.0));
  EXPECT_EQ(memory.echoes().size(), 1U);
  memory.forget(Stamp::from_seconds(3.2));
  EXPECT_TRUE(memory.echoes().empty());
}

TEST(EchoMemory, StaysWhereItIsWhileTheRobotMoves) {
  EchoMemory memory{RingParams{}};
  memory.take(scan_of(0.0, 3, 1.5), only(3));
  const Vector2d before = memory.echoes().front().front_r;
  Pose2 pose;
  for (int i = 0; i < 20; ++i) {
    const OdometryIncrement u = arc_increment(0.3, 0.5, Stamp{}, Stamp::from_seconds(0.04));
    pose = move(pose, u);
    memory.carry(u);
  }
  const Vector2d after = memory.echoes().front().front_r;
  const Pose2 in_world = compose(pose, {after.x(), after.y(), 0.0});
  EXPECT_LT((in_world.position() - before).norm(), 1e-9);
}

}  // namespace
}  // namespace vigia::pilot
