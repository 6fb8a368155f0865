#include "vigia/sim/wheel_slip.hpp"

#include "sim/exact_robot.hpp"
#include "sim/room.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/sim/robot.hpp"

namespace vigia::sim {
namespace {

constexpr double kSlipSigmas = 4.5;
constexpr double kStep_m = 0.01;

TEST(WheelSlip, LosesTheStatedShareOfTheWayInSlipsOfTheStatedNumberAndLength) {
  WheelSlipParams params;
  params.diameter = params.base = 0.0;
  WheelSlip slip(params, 1);
  constexpr int kSteps = 2'000'000;
  double lost = 0.0;
  double slipping = 0.0;
  int slips = 0;
  bool before = false;
  for (int i = 0; i < kSteps; ++i) {
    const bool now = slip.slipping();
    if (now && !before) ++slips;
    before = now;
    const ArcMotion ground = slip.over_ground({kStep_m, 0.0});
    if (!now) {
      ASSERT_EQ(ground.distance, kStep_m);
      ASSERT_EQ(ground.turn, 0.0);
      continue;
    }
    slipping += kStep_m;
    lost += kStep_m - ground.distance;
    ASSERT_GE(ground.distance, kStep_m * (1.0 - params.max_loss) - 1e-12);
    ASSERT_LE(ground.distance, kStep_m * (1.0 - params.min_loss) + 1e-12);
  }
  const double driven = kSteps * kStep_m;
  // Gaps are exponential, so the slips in the way that does not slip are a Poisson number.
  const double expected = params.per_m * (driven - slipping);
  EXPECT_NEAR(slips, expected, kSlipSigmas * std::sqrt(expected));
  const double mean_m = 0.5 * (params.min_m + params.max_m);
  const double sigma_m = (params.max_m - params.min_m) / std::sqrt(12.0);
  // A slip ends with the step in which its length is used up.
  EXPECT_NEAR(slipping / slips, mean_m + 0.5 * kStep_m,
              kSlipSigmas * sigma_m / std::sqrt(1.0 * slips) + 0.1 * kStep_m);
  EXPECT_NEAR(lost / slipping, 0.5 * (params.min_loss + params.max_loss),
              kSlipSigmas * 0.08 / std::sqrt(12.0) * 1.1 / std::sqrt(1.0 * slips));
}

TEST(WheelSlip, TurnsTheBaseDuringASlipByASkewOfItsOwnForEach) {
  WheelSlipParams params;
  params.diameter = params.base = 0.0;
  WheelSlip slip(params, 1);
  std::vector<double> skews;
  bool before = false;
  while (skews.size() < 20'000) {
    const bool now = slip.slipping();
    const double per_m = slip.over_ground({kStep_m, 0.0}).turn / kStep_m;
    // A slip keeps its skew as long as it lasts; without one the base does not turn.
    if (now && !before) skews.push_back(per_m);
    ASSERT_EQ(per_m, now ? skews.back() : 0.0);
    before = now;
  }
  double sum = 0.0;
  double square = 0.0;
  double neighbours = 0.0;
  for (std::size_t i = 0; i < skews.size(); ++i) {
    sum += skews[i];
    square += skews[i] * skews[i];
    if (i > 0) neighbours += skews[i] * skews[i - 1];
  }
  const double n = static_cast<double>(skews.size());
  const double sigma = params.skew_per_m;
  EXPECT_NEAR(sum / n, 0.0, kSlipSigmas * sigma / std::sqrt(n));
  EXPECT_NEAR(square / n / (sigma * sigma), 1.0, kSlipSigmas * std::sqrt(2.0 / n));
  EXPECT_NEAR(neighbours / n / (sigma * sigma), 0.0, kSlipSigmas / std::sqrt(n));
}

TEST(WheelSlip, TurnsTheBaseTheSameWayInReverse) {
  WheelSlipParams params;
  params.diameter = params.base = 0.0;
  WheelSlip forwards(params, 7);
  WheelSlip backwards(params, 7);
  double turned = 0.0;
  for (int i = 0; i < 10'000; ++i) {
    const ArcMotion there = forwards.over_ground({kStep_m, 0.0});
    const ArcMotion back = backwards.over_ground({-kStep_m, 0.0});
    ASSERT_EQ(back.distance, -there.distance);
    ASSERT_EQ(back.turn, there.turn);
    turned += std::abs(there.turn);
  }
  EXPECT_GT(turned, 0.0);
}

TEST(WheelSlip, ScaleErrorsStayAndHaveTheStatedSpread) {
  WheelSlipParams params;
  params.per_m = 0.0;
  double square = 0.0;
  constexpr int kSeeds = 2000;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    WheelSlip slip(params, seed);
    const ArcMotion first = slip.over_ground({1.0, 1.0});
    const ArcMotion second = slip.over_ground({1.0, 1.0});
    EXPECT_EQ(first.distance, second.distance);
    EXPECT_EQ(first.turn, second.turn);
    square += std::pow(first.distance - 1.0, 2) + std::pow(first.turn - 1.0, 2);
  }
  EXPECT_NEAR(square / (2.0 * kSeeds) / (0.005 * 0.005), 1.0,
              kSlipSigmas * std::sqrt(2.0 / (2.0 * kSeeds)));
}

using testing::exact_robot;

TEST(Robot, ReportsWhatItsWheelsDoNotWhatTheBaseDoes) {
  WheelSlipParams params;
  params.per_m = 0.0;
  params.diameter = 0.05;
  params.base = 0.0;
  Robot slipping(exact_robot(), {}, 8.0, 1);
  Robot firm(exact_robot(), {}, 8.0, 1);
  slipping.set_wheel_slip(WheelSlip(params, 4));
  for (Robot* robot : {&slipping, &firm}) {
    robot->command({0.2, 0.1}, {});
    robot->advance(Duration::from_seconds(5.0));
  }
  EXPECT_GT((slipping.truth().pose.position() - firm.truth().pose.position()).norm(), 1e-3);
  EXPECT_EQ(slipping.read_odometry().trans, firm.read_odometry().trans);
}

TEST(Robot, EncodersWithBacklashLagBehindByHalfTheirPlay) {
  Robot robot(exact_robot(), {}, 8.0, 1);
  robot.set_backlash(0.002);
  const auto run = [&](double rate, double seconds) {
    robot.command({}, {{rate, rate}, 0.0});
    robot.advance(Duration::from_seconds(seconds));
  };
  run(0.2, 1.0);
  EXPECT_NEAR(robot.truth().head.pan - robot.read_head().angles.pan, 0.001, 1e-9);
  EXPECT_NEAR(robot.truth().head.tilt - robot.read_head().angles.tilt, 0.001, 1e-9);
  run(-0.2, 1.0);
  EXPECT_NEAR(robot.truth().head.pan - robot.read_head().angles.pan, -0.001, 1e-9);
  // Within the play the reading does not move.
  run(0.0, 0.5);
  const double reading = robot.read_head().angles.pan;
  const double axis = robot.truth().head.pan;
  run(0.005, 0.2);
  EXPECT_GT(robot.truth().head.pan, axis);
  EXPECT_EQ(robot.read_head().angles.pan, reading);
}

}  // namespace
}  // namespace vigia::sim
