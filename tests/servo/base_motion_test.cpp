#include "vigia/servo/base_motion.hpp"

#include "head_bench.hpp"

#include <gtest/gtest.h>

namespace vigia::servo {
namespace {

TEST(BaseMotion, ForeseesTheMeanRatesOfABaseThatAccelerates) {
  HeadBench bench;
  BaseMotion motion({bench.base_limits, bench.tick_s});
  BaseRates odometry;
  for (int tick = 0; tick < 40; ++tick) {
    const BaseRates command = tick < 20 ? BaseRates{0.3, 0.5} : BaseRates{0.1, -0.8};
    const BaseRates expected = motion.expect(odometry, command);
    const Pose2 before = bench.pose;
    bench.advance(command, {});
    odometry = {(bench.pose.position() - before.position()).norm() / bench.tick_s,
                wrap_angle(bench.pose.theta - before.theta) / bench.tick_s};
    // The bench's rates climb in steps of a millisecond: 0.5·a·1 ms.
    EXPECT_NEAR(expected.v, odometry.v, 4e-4);
    EXPECT_NEAR(expected.w, odometry.w, 2e-3);
  }
}

TEST(BaseMotion, LearnsThatTheBaseRunsSlowerThanItsCommands) {
  BaseMotion motion({BaseLimits{}, 0.04});
  BaseRates expected;
  for (int tick = 0; tick < 2000; ++tick) expected = motion.expect({0.27, -0.01}, {0.3, 0.0});
  EXPECT_NEAR(expected.v, 0.27, 1e-4);
  EXPECT_NEAR(expected.w, -0.01, 1e-4);
}

TEST(BaseMotion, ForeseesNoMoreThanTheBaseCanDo) {
  BaseMotion motion({BaseLimits{}, 0.04});
  BaseRates expected;
  for (int tick = 0; tick < 100; ++tick) expected = motion.expect(expected, {5.0, 9.0});
  EXPECT_NEAR(expected.v, BaseLimits{}.speed, 1e-12);
  EXPECT_NEAR(expected.w, BaseLimits{}.turn_rate, 1e-12);
}

}  // namespace
}  // namespace vigia::servo
