#include "ring_doubt.hpp"

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"
#include "vigia/sim/range_ring.hpp"

namespace vigia::mission {
namespace {

FloorPlan corridor(const std::vector<Obstacle>& obstacles = {}) {
  return FloorPlan({{0.0, 0.0}, {26.0, 0.0}, {26.0, 2.0}, {0.0, 2.0}}, 2.8, {}, obstacles);
}

Belief belief_at(const Pose2& pose) {
  Belief belief;
  belief.pose = pose;
  belief.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
  return belief;
}

/// The doubt after some seconds of scans at @p truth, five a second, believed to be at @p believed.
double doubt(const FloorPlan& world, const FloorPlan& map, const Pose2& truth,
             const Pose2& believed, double seconds, std::uint64_t seed) {
  RingDoubt ring(map, {});
  sim::RangeRing sensors({}, seed);
  for (double t = 1.0; t < 1.0 + seconds; t += 0.2)
    ring.process(sensors.scan(Stamp::from_seconds(t), truth, world, {}), belief_at(believed));
  return ring.probability();
}

TEST(RingDoubt, StaysSmallWhereTheRobotIsAsItBelieves) {
  const FloorPlan plan = corridor();
  RandomStream random(1, "ring doubt");
  double greatest = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Pose2 pose{random.uniform(0.5, 25.5), random.uniform(0.5, 1.5),
                     random.uniform(-kPi, kPi)};
    greatest = std::max(greatest, doubt(plan, plan, pose, pose, 20.0, seed));
  }
  EXPECT_LT(greatest, 0.02);
}

TEST(RingDoubt, SeesWithinSecondsThatTheRobotStandsAcrossTheCorridor) {
  const FloorPlan plan = corridor();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_GT(doubt(plan, plan, {20.0, 1.0, 1.4}, {12.0, 1.0, 0.0}, 4.0, seed), 0.99) << seed;
  }
}

TEST(RingDoubt, IsNotRaisedByWhatTheMapLacks) {
  const FloorPlan map = corridor();
  const FloorPlan world = corridor({{{{8.0, 0.0}, {9.0, 0.0}, {9.0, 0.6}, {8.0, 0.6}}, 1.0},
                                    {{{7.0, 1.5}, {7.5, 1.5}, {7.5, 2.0}, {7.0, 2.0}}, 1.0}});
  const Pose2 pose{7.4, 0.8, 0.1};
  EXPECT_LT(doubt(world, map, pose, pose, 20.0, 3), 0.02);
}

TEST(RingDoubt, ForgivesAWallThatIsGoneOnceLandmarksHaveConfirmedThePlace) {
  const FloorPlan map = corridor({{{{5.0, 0.0}, {8.0, 0.0}, {8.0, 0.9}, {5.0, 0.9}}, 1.0}});
  const FloorPlan world = corridor();
  const Pose2 pose{6.0, 1.4, 0.0};
  RingDoubt ring(map, {});
  sim::RangeRing sensors({}, 7);
  ring.trust(sensors.scan(Stamp::from_seconds(0.5), pose, world, {}), belief_at(pose));
  for (double t = 1.0; t < 21.0; t += 0.2)
    ring.process(sensors.scan(Stamp::from_seconds(t), pose, world, {}), belief_at(pose));
  EXPECT_LT(ring.probability(), 0.02);
}

TEST(RingDoubt, LearnsNothingWithoutARing) {
  const FloorPlan plan = corridor();
  RingDoubt ring(plan, {});
  const double before = ring.probability();
  ring.process({Stamp::from_seconds(1.0), 0.0, {}}, belief_at({5.0, 1.0, 0.0}));
  EXPECT_EQ(ring.probability(), before);
}

}  // namespace
}  // namespace vigia::mission
