#include "vigia/sim/walkers.hpp"

#include "sim/room.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "vigia/sim/simulator.hpp"

namespace vigia::sim {
namespace {

constexpr double kTick_s = 0.04;

TEST(Walkers, WalkAboutBetweenTheWallsNoFasterThanTheyMay) {
  const FloorPlan plan = test_room().plan;
  const Bystander robot{{1.0, 1.0}, {0.0, 0.0}, 0.3};
  const PeopleParams params;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Walkers walkers(params, plan, robot, seed);
    std::vector<double> walked(3, 0.0);
    int standing = 0;
    for (int tick = 0; tick < 3000; ++tick) {
      const auto before = walkers.people();
      walkers.advance(kTick_s, robot);
      const auto after = walkers.people();
      for (std::size_t i = 0; i < after.size(); ++i) {
        const double step = (after[i].position - before[i].position).norm();
        ASSERT_LE(step, params.speed_mps * kTick_s + 1e-9);
        ASSERT_GE(plan.clearance(after[i].position), params.radius_m - 1e-9);
        walked[i] += step;
        if (step == 0.0) ++standing;
      }
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < i; ++j)
          ASSERT_GT((after[i].position - after[j].position).norm(), 2.0 * params.radius_m - 0.05);
    }
    // Two minutes: farther than across the room, with pauses.
    EXPECT_GT(*std::min_element(walked.begin(), walked.end()), 12.0) << "seed " << seed;
    EXPECT_GT(standing, 0);
  }
}

TEST(Walkers, DoNotWalkIntoARobotThatStands) {
  const FloorPlan plan = test_room().plan;
  const Bystander robot{{3.0, 3.5}, {0.0, 0.0}, 0.3};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Walkers walkers({}, plan, robot, seed);
    for (int tick = 0; tick < 3000; ++tick) {
      walkers.advance(kTick_s, robot);
      ASSERT_GT(walkers.clearance(robot.position) - robot.radius_m, 0.0) << "seed " << seed;
    }
  }
}

TEST(Walkers, StepOutOfTheWayOfARobotInTheOpen) {
  const FloorPlan plan({{0, 0}, {12, 0}, {12, 7}, {0, 7}}, 2.8, {}, {});
  PeopleParams params;
  params.count = 1;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Bystander robot{{1.0, 3.5}, {0.0, 0.0}, 0.3};
    Walkers walkers(params, plan, robot, seed);
    // The robot drives to where the person stood when it set out, again and again.
    Eigen::Vector2d goal = robot.position;
    for (int tick = 0; tick < 3000; ++tick) {
      if ((goal - robot.position).norm() < 0.05) goal = walkers.people().front().position;
      const Eigen::Vector2d to = goal - robot.position;
      robot.velocity = 0.3 * to.normalized();
      robot.position += robot.velocity * kTick_s;
      walkers.advance(kTick_s, robot);
      ASSERT_GT(walkers.clearance(robot.position) - robot.radius_m, 0.0) << "seed " << seed;
    }
  }
}

TEST(Walkers, AreSeenByTheRangeRingAndCountAsSomethingToCollideWith) {
  RobotSetup setup = pan_tilt_zoom_robot(
      usual_robot(), ZoomCalibration(640, 480, 319.5, 239.5, {{8, 582, 0.0}, {48, 3490, 0.0}}));
  setup.range_ring.emplace();
  setup.range_ring->dropout = setup.range_ring->sigma_m = setup.range_ring->sigma_relative = 0.0;
  DisturbanceParams disturbances;
  disturbances.people.emplace();
  Simulator world(setup, test_room(), nullptr, {3.0, 3.5, 0.0}, 2, disturbances);
  int seen = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    world.advance({40'000'000});
    EXPECT_LE(world.clearance(), world.clearance_of_people());
    const auto scan = world.scan();
    const auto nearest =
        std::min_element(scan.readings.begin(), scan.readings.end(),
                         [](const auto& a, const auto& b) { return a.range_m < b.range_m; });
    // Beams of 15° every 15° leave no gap: the nearest thing is heard at its distance.
    const double distance = std::min(world.clearance() + setup.robot.radius_m, 4.0);
    EXPECT_NEAR(nearest->range_m, distance, 1e-6);
    if (world.clearance_of_people() <= world.clearance()) ++seen;
  }
  EXPECT_GT(seen, 0);
}

}  // namespace
}  // namespace vigia::sim
