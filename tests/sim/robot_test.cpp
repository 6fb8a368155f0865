#include "vigia/sim/robot.hpp"

#include "sim/exact_robot.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace vigia::sim {
namespace {

using testing::exact_robot;

constexpr Duration kTick{40'000'000};

TEST(Robot, KeepsEachAxisWithinItsOwnRateAndAcceleration) {
  const RobotParams params = exact_robot();
  Robot robot(params, {}, 8.0, 1);
  robot.set_zoom_range(8.0, 48.0);
  robot.command({9.0, -9.0}, {{9.0, 9.0}, 99.0});
  RobotTruth before = robot.truth();
  const double dt = kTick.seconds();
  for (int i = 0; i < 50; ++i) {
    robot.advance(kTick);
    const RobotTruth& now = robot.truth();
    EXPECT_LE(std::abs(now.base.v - before.base.v), params.base.acceleration * dt + 1e-12);
    EXPECT_LE(std::abs(now.base.w - before.base.w), params.base.turn_acceleration * dt + 1e-12);
    EXPECT_LE(std::abs(now.head_rates.pan - before.head_rates.pan),
              params.head_limits.acceleration * dt + 1e-12);
    EXPECT_LE(now.base.v, params.base.speed);
    EXPECT_GE(now.base.w, -params.base.turn_rate);
    EXPECT_LE(now.head_rates.pan, params.head_limits.rate);
    EXPECT_LE(now.zoom_mm - before.zoom_mm, params.head_limits.zoom_rate_mm_s * dt + 1e-12);
    before = now;
  }
  // A pan saccade at its limit must not slow the base.
  EXPECT_DOUBLE_EQ(robot.truth().base.v, params.base.speed);
  EXPECT_DOUBLE_EQ(robot.truth().base.w, -params.base.turn_rate);
  EXPECT_NEAR(robot.truth().zoom_mm, 8.0 + 2.0 * params.head_limits.zoom_rate_mm_s, 1e-9);
}

TEST(Robot, StopsAtThePanStopAndDoesNotWrapAround) {
  Robot robot(exact_robot(), {}, 8.0, 1);
  robot.command({}, {{1.5, 1.5}, 0.0});
  for (int i = 0; i < 200; ++i) robot.advance(kTick);
  EXPECT_DOUBLE_EQ(robot.truth().head.pan, kPi);
  EXPECT_DOUBLE_EQ(robot.truth().head.tilt, 0.5 * kPi);
  EXPECT_EQ(robot.truth().head_rates.pan, 0.0);
  robot.command({}, {{-1.5, 0.0}, 0.0});
  robot.advance(Duration::from_seconds(1.0));
  EXPECT_LT(robot.truth().head.pan, kPi - 1.0);
}

TEST(Robot, DrivesAnExactArcWhateverTheTick) {
  const RobotParams params = exact_robot();
  for (const int ticks : {1, 7, 100}) {
    Robot robot(params, {1.0, 2.0, 0.3}, 8.0, 1);
    robot.command({0.3, 0.5}, {});
    robot.advance(Duration::from_seconds(2.0));  // now at speed
    const Pose2 start = robot.truth().pose;
    const std::int64_t step = 2'000'000'000 / ticks;
    for (int i = 0; i < ticks; ++i) robot.advance({step});
    const double turned = 0.5 * 1e-9 * static_cast<double>(step * ticks);
    const double radius = 0.3 / 0.5;
    const Pose2& end = robot.truth().pose;
    EXPECT_NEAR(end.x, start.x + radius * (std::sin(start.theta + turned) - std::sin(start.theta)),
                1e-9);
    EXPECT_NEAR(end.y, start.y - radius * (std::cos(start.theta + turned) - std::cos(start.theta)),
                1e-9);
  }
}

TEST(Robot, OdometryWithoutNoiseReproducesTheTruePose) {
  Robot robot(exact_robot(), {1.0, 2.0, 0.3}, 8.0, 1);
  Pose2 reckoned{1.0, 2.0, 0.3};
  for (int i = 0; i < 200; ++i) {
    // Forward, backward, turning on the spot, standing.
    robot.command({0.3 * std::sin(0.1 * i), i % 40 < 30 ? 0.7 * std::cos(0.07 * i) : 0.0}, {});
    robot.advance(kTick);
    if (i % 3 == 0) reckoned = move(reckoned, robot.read_odometry());
  }
  reckoned = move(reckoned, robot.read_odometry());
  EXPECT_LT(difference(reckoned, robot.truth().pose).norm(), 1e-9);
}

TEST(Robot, OdometryErrorHasTheControlCovariance) {
  RobotParams params = exact_robot();
  params.odometry = {0.02, 0.01, 0.03};
  constexpr int kDraws = 4000;
  constexpr double kSigmas = 4.0;
  Robot robot(params, {}, 8.0, 11);
  robot.command({0.3, 0.4}, {});
  robot.advance(Duration::from_seconds(2.0));
  robot.read_odometry();
  const OdometryIncrement truth = arc_increment(0.3, 0.4, {}, Stamp::from_seconds(0.2));
  const Eigen::Matrix3d expected = control_covariance(truth, params.odometry);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    robot.advance(Duration::from_seconds(0.2));
    const OdometryIncrement u = robot.read_odometry();
    const Eigen::Vector3d error(u.rot1 - truth.rot1, u.trans - truth.trans, u.rot2 - truth.rot2);
    mean += error / kDraws;
    second += error * error.transpose() / kDraws;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(mean(i)), kSigmas * std::sqrt(expected(i, i) / kDraws));
    EXPECT_NEAR(second(i, i), expected(i, i), kSigmas * expected(i, i) * std::sqrt(2.0 / kDraws));
    for (int j = 0; j < i; ++j)
      EXPECT_LT(std::abs(second(i, j)),
                kSigmas * std::sqrt(expected(i, i) * expected(j, j) / kDraws));
  }
}

TEST(Robot, LookErrorsAreConstantDuringALookAndIndependentBetweenLooks) {
  RobotParams params = exact_robot();
  params.sensor = {from_deg(0.3), 0.0, 0.004};
  constexpr int kLooks = 4000;
  constexpr double kSigmas = 4.0;
  Robot robot(params, {}, 8.0, 5);
  Eigen::Vector3d second = Eigen::Vector3d::Zero();
  double pan_tilt = 0.0;
  double lagged = 0.0;
  double last = 0.0;
  for (int i = 0; i < kLooks; ++i) {
    robot.begin_look();
    const HeadReading first = robot.read_head();
    robot.advance(kTick);
    const HeadReading again = robot.read_head();
    EXPECT_EQ(first.angles.pan, again.angles.pan);
    EXPECT_EQ(first.angles.tilt, again.angles.tilt);
    const double pan = robot.truth().head.pan - first.angles.pan;
    const double tilt = robot.truth().head.tilt - first.angles.tilt;
    EXPECT_DOUBLE_EQ(pan, robot.truth().look_angle_error.pan);
    const double focal = robot.truth().look_log_focal_error;
    second += Eigen::Vector3d(pan * pan, tilt * tilt, focal * focal) / kLooks;
    pan_tilt += pan * tilt / kLooks;
    lagged += pan * last / kLooks;
    last = pan;
  }
  const double variance = from_deg(0.3) * from_deg(0.3);
  const double se = std::sqrt(1.0 / kLooks);
  EXPECT_NEAR(second(0), variance, kSigmas * variance * std::sqrt(2.0) * se);
  EXPECT_NEAR(second(1), variance, kSigmas * variance * std::sqrt(2.0) * se);
  EXPECT_NEAR(second(2), 0.004 * 0.004, kSigmas * 0.004 * 0.004 * std::sqrt(2.0) * se);
  EXPECT_LT(std::abs(pan_tilt), kSigmas * variance * se);
  EXPECT_LT(std::abs(lagged), kSigmas * variance * se);
}

TEST(Robot, ReadingErrorIsWhite) {
  RobotParams params = exact_robot();
  params.sensor = {0.0, 0.001, 0.0};
  constexpr int kReadings = 4000;
  constexpr double kSigmas = 4.0;
  Robot robot(params, {}, 8.0, 5);
  double second = 0.0;
  double lagged = 0.0;
  double last = 0.0;
  for (int i = 0; i < kReadings; ++i) {
    const double error = robot.truth().head.pan - robot.read_head().angles.pan;
    second += error * error / kReadings;
    lagged += error * last / kReadings;
    last = error;
  }
  EXPECT_NEAR(second, 1e-6, kSigmas * 1e-6 * std::sqrt(2.0 / kReadings));
  EXPECT_LT(std::abs(lagged), kSigmas * 1e-6 / std::sqrt(1.0 * kReadings));
}

RobotParams omnidirectional_robot() {
  RobotParams params = exact_robot();
  params.base.side_speed = 0.25;
  params.base.side_acceleration = 0.4;
  return params;
}

TEST(OmnidirectionalRobot, KeepsEachOfItsThreeAxesWithinItsOwnLimits) {
  const RobotParams params = omnidirectional_robot();
  Robot robot(params, {}, 8.0, 1);
  robot.command({9.0, -9.0, 9.0}, {});
  RobotTruth before = robot.truth();
  for (int i = 0; i < 50; ++i) {
    robot.advance(kTick);
    EXPECT_LE(std::abs(robot.truth().base.vy - before.base.vy),
              params.base.side_acceleration * kTick.seconds() + 1e-12);
    before = robot.truth();
  }
  EXPECT_DOUBLE_EQ(before.base.v, params.base.speed);
  EXPECT_DOUBLE_EQ(before.base.w, -params.base.turn_rate);
  EXPECT_DOUBLE_EQ(before.base.vy, params.base.side_speed);
}

TEST(OmnidirectionalRobot, AUnicycleDoesNotGoSideways) {
  Robot robot(exact_robot(), {}, 8.0, 1);
  robot.command({0.0, 0.0, 0.3}, {});
  robot.advance(Duration::from_seconds(1.0));
  EXPECT_EQ(robot.truth().pose.y, 0.0);
}

TEST(OmnidirectionalRobot, OdometryWithoutNoiseReproducesTheTruePose) {
  Robot robot(omnidirectional_robot(), {1.0, 2.0, 0.3}, 8.0, 1);
  Pose2 reckoned{1.0, 2.0, 0.3};
  for (int i = 0; i < 200; ++i) {
    const double s = 0.05 * i;
    robot.command({0.3 * std::cos(s), 0.4 * std::sin(s), -0.2 * std::sin(0.7 * s)}, {});
    robot.advance(kTick);
    reckoned = move(reckoned, robot.read_odometry());
  }
  EXPECT_LT(difference(reckoned, robot.truth().pose).norm(), 1e-9);
}

TEST(OmnidirectionalRobot, GoesSidewaysWithoutMoreErrorOfHeading) {
  RobotParams params = omnidirectional_robot();
  params.odometry = {0.0, 0.0, 0.05};
  Robot robot(params, {}, 8.0, 3);
  robot.command({0.0, 0.0, 0.25}, {});
  for (int i = 0; i < 100; ++i) {
    robot.advance(kTick);
    const OdometryIncrement u = robot.read_odometry();
    EXPECT_NEAR(u.rot1 + u.rot2, 0.0, 1e-12);
  }
  EXPECT_GT(robot.truth().pose.y, 0.7);
}

}  // namespace
}  // namespace vigia::sim
