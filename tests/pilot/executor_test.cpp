#include "executor.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/odometry.hpp"
#include "vigia/core/random.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

constexpr double kRadius = 0.27;

TEST(Executor, LeavesACommandAloneWithNothingInItsWay) {
  const Executor executor(kRadius, {}, {});
  const std::vector<Hazard> aside{{{0.0, 0.42}, true}, {{-0.3, 0.0}, false}, {{1.5, 0.0}, false}};
  const BaseRates rates = executor.execute({0.3, 0.1}, aside);
  EXPECT_EQ(rates.v, 0.3);
  EXPECT_EQ(rates.w, 0.1);
}

TEST(Executor, KeepsTheLimitsOfTheBase) {
  const BaseLimits limits;
  const Executor executor(kRadius, limits, {});
  const BaseRates rates = executor.execute({5.0, -7.0}, {});
  EXPECT_EQ(rates.v, limits.speed);
  EXPECT_EQ(rates.w, -limits.turn_rate);
  EXPECT_EQ(executor.execute({-1.0, 0.0}, {}).v, 0.0);
}

TEST(Executor, ABaseThatStandsBeforeSomethingMayTurnAndDriveAway) {
  const Executor executor(kRadius, {}, {});
  const std::vector<Hazard> before{{{0.32, 0.0}, false}};
  EXPECT_EQ(executor.execute({0.2, 0.0}, before).v, 0.0);
  EXPECT_EQ(executor.execute({0.0, 0.5}, before).w, 0.5);
  const std::vector<Hazard> behind{{{-0.28, 0.1}, false}};
  EXPECT_EQ(executor.execute({0.2, 0.0}, behind).v, 0.2);
}

TEST(Executor, WhateverIsWantedTheBaseStopsBeforeItTouchesAnything) {
  const BaseLimits limits;
  const Executor executor(kRadius, limits, {});
  RandomStream random(3, "hazards");
  for (int trial = 0; trial < 300; ++trial) {
    Pose2 pose;
    BaseRates rates;
    std::vector<Vector2d> points;
    while (points.size() < 6) {
      const Vector2d p(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
      if (p.norm() > kRadius + 0.02) points.push_back(p);
    }
    BaseRates wanted;
    for (int tick = 0; tick < 100; ++tick) {
      if (tick % 10 == 0) wanted = {random.uniform(0.0, 0.3), random.uniform(-0.8, 0.8)};
      std::vector<Hazard> hazards;
      for (const Vector2d& p : points) {
        const Pose2 seen = compose(inverse(pose), {p.x(), p.y(), 0.0});
        hazards.push_back({seen.position(), tick % 2 == 0});
      }
      const BaseRates command = executor.execute(wanted, hazards);
      for (int i = 0; i < 8; ++i) {
        const double h = 0.005;
        rates.v +=
            std::clamp(command.v - rates.v, -limits.acceleration * h, limits.acceleration * h);
        rates.w += std::clamp(command.w - rates.w, -limits.turn_acceleration * h,
                              limits.turn_acceleration * h);
        pose = move(pose, arc_increment(rates.v, rates.w, Stamp{}, Stamp::from_seconds(h)));
        for (const Vector2d& p : points)
          ASSERT_GT((p - pose.position()).norm(), kRadius) << "trial " << trial;
      }
    }
  }
}

}  // namespace
}  // namespace vigia::pilot
