#include "vigia/pilot/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/odometry.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

/// Distance of a point from a whole path.
double distance_to(const Path& path, const Vector2d& p) {
  return (path.at(path.project(p, 0.0, path.length())) - p).norm();
}

/// A base under limits of acceleration that follows at 25 Hz.
struct Drive {
  explicit Drive(const Path& path, const Pose2& start)
      : follower(path, limits, PathFollowerParams{}), pose(start) {}

  void tick() {
    Pose2 estimate = pose;
    estimate.x += estimate_offset.x();
    estimate.y += estimate_offset.y();
    const BaseRates command = follower.step(estimate);
    for (int i = 0; i < 40; ++i) {
      constexpr double kStep = 1e-3;
      rates.v += std::clamp(command.v - rates.v, -limits.acceleration * kStep,
                            limits.acceleration * kStep);
      rates.w += std::clamp(command.w - rates.w, -limits.turn_acceleration * kStep,
                            limits.turn_acceleration * kStep);
      pose = move(pose, arc_increment(rates.v, rates.w, Stamp{}, Stamp::from_seconds(kStep)));
    }
    seconds += 0.04;
    worst = std::max(worst, distance_to(follower.path(), pose.position()));
  }
  bool run(double limit_s) {
    while (!follower.arrived() && seconds < limit_s) tick();
    return follower.arrived();
  }

  BaseLimits limits;
  PathFollower follower;
  Pose2 pose;
  BaseRates rates;
  Vector2d estimate_offset = Vector2d::Zero();
  double seconds = 0.0;
  double worst = 0.0;  ///< distance from the path so far
};

Path square_corners() {
  return Path({{0.0, 0.0}, {3.0, 0.0}, {3.0, 2.0}, {5.0, 2.0}, {5.0, 0.5}}).resampled(0.05);
}

TEST(PathFollower, StaysWithinThreeCentimetresRoundSquareCorners) {
  Drive drive(square_corners(), {0.0, 0.0, 0.0});
  ASSERT_TRUE(drive.run(120.0));
  testing::Test::RecordProperty("worst_m", std::to_string(drive.worst));
  testing::Test::RecordProperty("seconds", std::to_string(drive.seconds));
  EXPECT_LE(drive.worst, 0.03);
}

TEST(PathFollower, StaysWithinThreeCentimetresOnBendsOfEveryAngle) {
  for (double bend = 5.0; bend <= 180.0; bend += 5.0) {
    const double angle = from_deg(bend);
    const Path path =
        Path({{0.0, 0.0}, {2.0, 0.0}, {2.0 + 2.0 * std::cos(angle), 2.0 * std::sin(angle)}})
            .resampled(0.05);
    Drive drive(path, {0.0, 0.0, 0.0});
    ASSERT_TRUE(drive.run(60.0)) << bend << " degrees";
    EXPECT_LE(drive.worst, 0.03) << bend << " degrees";
  }
}

TEST(PathFollower, StaysWithinThreeCentimetresOnAnArc) {
  std::vector<Vector2d> points;
  for (double angle = 0.0; angle < 1.5 * kPi; angle += 0.05)
    points.emplace_back(1.0 * std::sin(angle), 1.0 - std::cos(angle));
  Drive drive(Path(points), {0.0, 0.0, 0.0});
  ASSERT_TRUE(drive.run(60.0));
  EXPECT_LE(drive.worst, 0.03);
}

TEST(PathFollower, RoundsACornerOfManySmallBendsWithoutStopping) {
  // As a route turns round the end of a wall, 0.46 m away from it.
  std::vector<Vector2d> points{{0.0, 0.0}, {2.0, 0.0}};
  for (int i = 1; i <= 8; ++i) {
    const double heading = from_deg(22.5 * i);
    const double length = i < 8 ? 0.18 : 2.0;
    points.push_back(points.back() + length * Vector2d(std::cos(heading), std::sin(heading)));
  }
  Drive drive(Path(points).resampled(0.05), {0.0, 0.0, 0.0});
  double slowest = 1.0;
  while (!drive.follower.arrived() && drive.seconds < 60.0) {
    drive.tick();
    const double station = drive.follower.station();
    if (station > 0.5 && station < drive.follower.path().length() - 0.5)
      slowest = std::min(slowest, drive.rates.v);
  }
  EXPECT_TRUE(drive.follower.arrived());
  EXPECT_LE(drive.worst, 0.03);
  EXPECT_GT(slowest, 0.2);
}

TEST(PathFollower, ArrivesWithinItsToleranceAndThenAsksForNothing) {
  Drive drive(square_corners(), {0.0, 0.0, 0.0});
  ASSERT_TRUE(drive.run(120.0));
  EXPECT_LE((drive.pose.position() - Vector2d(5.0, 0.5)).norm(),
            PathFollowerParams{}.goal_tolerance_m + 0.01);
  const BaseRates rates = drive.follower.step({0.0, 0.0, 0.0});
  EXPECT_EQ(rates.v, 0.0);
  EXPECT_EQ(rates.w, 0.0);
  EXPECT_EQ(drive.follower.station(), drive.follower.path().length());
}

TEST(PathFollower, DrivesAtFullSpeedAwayFromCornersAndEnds) {
  Drive drive(Path({{0.0, 0.0}, {6.0, 0.0}}).resampled(0.05), {0.0, 0.0, 0.0});
  ASSERT_TRUE(drive.run(60.0));
  // 6 m at 0.3 m/s, a second for speeding up and slowing down, and the exponential end:
  // 0.3 m to 0.05 m at 1/s.
  EXPECT_LT(drive.seconds, 6.0 / 0.3 + 1.0 + std::log(6.0));
}

TEST(PathFollower, TurnsOnTheSpotWhenItFacesAway) {
  Drive drive(Path({{0.0, 0.0}, {3.0, 0.0}}).resampled(0.05), {0.0, 0.0, 3.0});
  const BaseRates rates = drive.follower.step(drive.pose);
  EXPECT_EQ(rates.v, 0.0);
  EXPECT_LT(rates.w, 0.0);
  ASSERT_TRUE(drive.run(60.0));
  EXPECT_LE(drive.worst, 0.03);
}

TEST(PathFollower, FollowsAPathThatCrossesItselfInItsOrder) {
  const Path path =
      Path({{0.0, 0.0}, {3.0, 0.0}, {3.0, 1.5}, {1.5, 1.5}, {1.5, -1.5}}).resampled(0.05);
  Drive drive(path, {0.0, 0.0, 0.0});
  double last = 0.0;
  while (!drive.follower.arrived() && drive.seconds < 120.0) {
    drive.tick();
    EXPECT_GE(drive.follower.station(), last);
    if (!drive.follower.arrived()) {
      EXPECT_LT(drive.follower.station() - last, 0.06);
    }
    last = drive.follower.station();
  }
  EXPECT_TRUE(drive.follower.arrived());
  EXPECT_LE(drive.worst, 0.03);
}

TEST(PathFollower, DrivesToTheTipOfAPathThatReturnsOnItself) {
  Drive drive(Path({{0.0, 0.0}, {2.0, 0.0}, {0.5, 0.0}}).resampled(0.05), {0.0, 0.01, 0.0});
  double farthest = 0.0;
  while (!drive.follower.arrived() && drive.seconds < 60.0) {
    drive.tick();
    farthest = std::max(farthest, drive.pose.x);
  }
  EXPECT_TRUE(drive.follower.arrived());
  EXPECT_NEAR(farthest, 2.0, 0.03);
}

TEST(PathFollower, ComesBackFromAThirdOfAMetreOffThePath) {
  for (const double side : {-0.3, 0.3}) {
    Drive drive(Path({{0.0, 0.0}, {5.0, 0.0}}).resampled(0.05), {0.0, side, 0.0});
    while (drive.pose.x < 2.5 && drive.seconds < 60.0) drive.tick();
    EXPECT_LT(std::abs(drive.pose.y), 0.02);
    // It comes back without swinging far over to the other side.
    double over = 0.0;
    while (!drive.follower.arrived() && drive.seconds < 60.0) {
      drive.tick();
      over = std::max(over, -drive.pose.y * (side > 0.0 ? 1.0 : -1.0));
    }
    EXPECT_LT(over, 0.02);
  }
}

TEST(PathFollower, AJumpOfTheEstimateIsTakenUpWithoutOscillation) {
  Drive drive(Path({{0.0, 0.0}, {6.0, 0.0}}).resampled(0.05), {0.0, 0.0, 0.0});
  while (drive.pose.x < 1.5) drive.tick();
  drive.estimate_offset = {-0.04, 0.05};
  double slowest = 1.0;
  int sign_changes = 0;
  double last_error = 1.0;
  while (drive.pose.x < 4.5) {
    drive.tick();
    slowest = std::min(slowest, drive.rates.v);
    const double error = drive.pose.y + 0.05;
    if (std::abs(error) > 2e-3 && error * last_error < 0.0) ++sign_changes;
    if (std::abs(error) > 2e-3) last_error = error;
  }
  EXPECT_GT(slowest, 0.29);
  EXPECT_LE(sign_changes, 1);
  EXPECT_NEAR(drive.pose.y, -0.05, 2e-3);
}

TEST(PathFollower, AJumpBesideTheEndIsDrivenOut) {
  Drive drive(Path({{0.0, 0.0}, {2.0, 0.0}}).resampled(0.05), {0.0, 0.0, 0.0});
  while (drive.pose.x < 1.85) drive.tick();
  drive.estimate_offset = {0.15, 0.2};
  ASSERT_TRUE(drive.run(60.0));
  EXPECT_LE((drive.pose.position() + drive.estimate_offset - Vector2d(2.0, 0.0)).norm(),
            PathFollowerParams{}.goal_tolerance_m + 0.01);
}

TEST(PathFollower, NeverAsksForMoreThanTheBaseCanDo) {
  const Path path = square_corners();
  const BaseLimits limits;
  for (double x = -0.5; x < 5.5; x += 0.23) {
    for (double y = -0.5; y < 2.5; y += 0.19) {
      for (double theta = -3.1; theta < 3.1; theta += 0.7) {
        PathFollower follower(path, limits, {});
        const BaseRates rates = follower.step({x, y, theta});
        EXPECT_GE(rates.v, 0.0);
        EXPECT_LE(rates.v, limits.speed + 1e-12);
        EXPECT_LE(std::abs(rates.w), limits.turn_rate + 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace vigia::pilot
