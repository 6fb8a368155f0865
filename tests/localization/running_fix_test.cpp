#include "vigia/localization/running_fix.hpp"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"
#include "vigia/localization/published_running_fix.hpp"

namespace vigia::localization {
namespace {

/// What a robot measures without error that went from @p first to @p second.
RunningFixInput exact_input(const Eigen::Vector2d& landmark, const Pose2& first,
                            const Pose2& second) {
  RunningFixInput input;
  input.landmark.p_w = landmark;
  const auto sighting = [&](const Pose2& pose) {
    const Eigen::Vector2d to = landmark - pose.position();
    PolarSighting seen{to.norm(), wrap_angle(std::atan2(to.y(), to.x()) - pose.theta),
                       Eigen::Matrix2d::Zero()};
    seen.covariance.diagonal() << 1e-4, 1e-6;
    return seen;
  };
  input.first = sighting(first);
  input.second = sighting(second);
  input.motion.displacement_m = second.position() - first.position();
  input.motion.turn = wrap_angle(second.theta - first.theta);
  return input;
}

const Eigen::Vector2d kCorner(1.5, 0.2);
const Pose2 kFirst{0.3, -0.2, 0.3};
const Pose2 kSecond{0.9, 0.3, -0.2};

double nearest_m(const RunningFix& fix, const Pose2& truth) {
  double nearest = 1e9;
  for (const auto& c : fix.candidates)
    nearest = std::min(nearest, difference(c.pose, truth).norm());
  return nearest;
}

TEST(RunningFix, WithoutAPriorBothCandidatesAreKeptAndOneIsThePose) {
  const RunningFix fix = running_fix(exact_input(kCorner, kFirst, kSecond));
  EXPECT_EQ(fix.status, RunningFixStatus::ambiguous);
  ASSERT_EQ(fix.candidates.size(), 2U);
  EXPECT_EQ(fix.candidates[0].weight, 0.5);
  EXPECT_LT(nearest_m(fix, kSecond), 1e-9);
}

TEST(RunningFix, ARoughPriorResolvesTheTwo) {
  Prior rough{{0.85, 0.35, -0.3}, 0.04 * Eigen::Matrix3d::Identity()};
  const RunningFix fix = running_fix(exact_input(kCorner, kFirst, kSecond), rough);
  EXPECT_EQ(fix.status, RunningFixStatus::found);
  EXPECT_LT(difference(fix.candidates[0].pose, kSecond).norm(), 1e-9);
}

TEST(RunningFix, AWayAlongYIsNoExceptionWherePrintedEquation4DividesByZero) {
  const Pose2 along_y{kFirst.x, 0.4, 0.0};
  const RunningFixInput input = exact_input(kCorner, kFirst, along_y);
  EXPECT_LT(nearest_m(running_fix(input), along_y), 1e-9);
  EXPECT_EQ(published_running_fix(kCorner, input.first.range_m, input.second.range_m,
                                  input.motion.displacement_m)
                .status,
            PublishedFixStatus::divides_by_zero);
}

TEST(RunningFix, ElsewhereThePrintedEquationsCrossTheCirclesAtTheSamePlaces) {
  RandomStream random(5, "fix");
  for (int i = 0; i < 50; ++i) {
    const Pose2 a{random.uniform(0.1, 1.4), random.uniform(-0.6, 0.6), 0.0};
    const Pose2 b{random.uniform(0.1, 1.4), random.uniform(-0.6, 0.6), 0.0};
    const RunningFixInput input = exact_input(kCorner, a, b);
    const RunningFix fix = running_fix(input);
    const PublishedFix printed = published_running_fix(
        kCorner, input.first.range_m, input.second.range_m, input.motion.displacement_m);
    ASSERT_EQ(printed.status, PublishedFixStatus::found);
    for (const auto& c : fix.candidates)
      EXPECT_LT(std::min((c.pose.position() - printed.positions[0]).norm(),
                         (c.pose.position() - printed.positions[1]).norm()),
                1e-7);
  }
}

TEST(RunningFix, CirclesThatDoNotMeetAreAStatus) {
  RunningFixInput input = exact_input(kCorner, kFirst, kSecond);
  input.first.range_m = 3.0;
  EXPECT_EQ(running_fix(input).status, RunningFixStatus::circles_do_not_meet);
  input.first.range_m = 0.01;
  EXPECT_EQ(running_fix(input).status, RunningFixStatus::circles_do_not_meet);
  EXPECT_EQ(
      published_running_fix(kCorner, 3.0, input.second.range_m, input.motion.displacement_m).status,
      PublishedFixStatus::circles_do_not_meet);
}

TEST(RunningFix, ARobotThatDrivesStraightAtTheLandmarkOrStaysIsDegenerate) {
  const Pose2 ahead{0.7, 0.1, 0.0};
  const Eigen::Vector2d towards = (kCorner - ahead.position()).normalized();
  const Eigen::Vector2d on = ahead.position() + 0.3 * towards + 0.01 * Eigen::Vector2d(0.0, 1.0);
  EXPECT_EQ(running_fix(exact_input(kCorner, ahead, {on.x(), on.y(), 0.0})).status,
            RunningFixStatus::degenerate);
  EXPECT_EQ(running_fix(exact_input(kCorner, ahead, ahead)).status, RunningFixStatus::degenerate);
}

TEST(RunningFix, TheGateIsTheSineOfTheAngleBetweenTheLinesOfSight) {
  const RunningFix fix = running_fix(exact_input(kCorner, kFirst, kSecond));
  const Eigen::Vector2d a = (kCorner - kFirst.position()).normalized();
  const Eigen::Vector2d b = (kCorner - kSecond.position()).normalized();
  EXPECT_NEAR(fix.sin_gamma, std::abs(cross(a, b)), 1e-9);
}

TEST(RunningFix, ADisplacementInTheRobotsOwnAxesTakesAHeading) {
  RunningFixInput input = exact_input(kCorner, kFirst, kSecond);
  input.motion.frame = MotionFrame::body;
  const Eigen::Vector2d d_w = input.motion.displacement_m;
  const Eigen::Vector2d u = unit_vector(kFirst.theta);
  input.motion.displacement_m << u.dot(d_w), cross(u, d_w);
  EXPECT_EQ(running_fix(input).status, RunningFixStatus::no_heading);
  input.heading = HeadingPrior{kSecond.theta, 0.01};
  EXPECT_LT(nearest_m(running_fix(input), kSecond), 1e-9);
}

TEST(RunningFix, TheSpreadOfNoisyFixesIsTheCovarianceOfTheCandidate) {
  RunningFixInput exact = exact_input(kCorner, kFirst, kSecond);
  exact.motion.covariance.diagonal() << 1e-4, 2e-4, 0.0;
  exact.landmark.covariance.diagonal() << 1e-4, 0.5e-4;
  Prior rough{kSecond, 0.04 * Eigen::Matrix3d::Identity()};
  const Eigen::Matrix3d claimed = running_fix(exact, rough).candidates[0].covariance;
  constexpr int kDraws = 4000;
  RandomStream random(7, "fix");
  double nees = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    RunningFixInput noisy = exact;
    noisy.first.range_m += 0.01 * random.normal();
    noisy.second.range_m += 0.01 * random.normal();
    noisy.second.bearing += 0.001 * random.normal();
    noisy.motion.displacement_m +=
        Eigen::Vector2d(0.01 * random.normal(), std::sqrt(2e-4) * random.normal());
    noisy.landmark.p_w +=
        Eigen::Vector2d(0.01 * random.normal(), std::sqrt(0.5e-4) * random.normal());
    const Eigen::Vector3d e = difference(running_fix(noisy, rough).candidates[0].pose, kSecond);
    nees += e.dot(claimed.inverse() * e) / kDraws;
  }
  // Mean of 4000 χ² of 3 degrees of freedom: standard error √(6/4000) = 0.04. Three of them and
  // 2 % for the circles' curvature.
  EXPECT_NEAR(nees, 3.0, 0.18);
}

TEST(PublishedHeading, IsRightFromTheSideThatItIsPrintedForAndTurnedElsewhere) {
  const auto seen = [](const Eigen::Vector2d& landmark, const Pose2& pose) {
    const Eigen::Vector2d to = landmark - pose.position();
    const Eigen::Vector2d u = unit_vector(pose.theta);
    return Eigen::Vector2d(u.dot(to), cross(u, to));
  };
  const Pose2 to_yellow{0.6, -0.3, 0.4};
  EXPECT_NEAR(published_heading_yellow(kCorner, to_yellow.position(), seen(kCorner, to_yellow)),
              0.4, 1e-12);
  const Eigen::Vector2d blue(0.0, -0.2);
  const Pose2 to_blue{0.6, 0.3, 3.3 - 2.0 * kPi};
  EXPECT_NEAR(published_heading_blue(blue, to_blue.position(), seen(blue, to_blue)),
              wrap_angle(3.3), 1e-12);
  // The same room with its origin in the middle: eq. 8 takes the landmark's x for zero.
  const Eigen::Vector2d middle(0.75, 0.0);
  EXPECT_GT(std::abs(wrap_angle(published_heading_blue(blue - middle, to_blue.position() - middle,
                                                       seen(blue, to_blue)) -
                                3.3)),
            0.5);
  // Eq. 7 for a landmark behind the robot's x.
  EXPECT_NEAR(std::abs(wrap_angle(
                  published_heading_yellow(blue, to_blue.position(), seen(blue, to_blue)) - 3.3)),
              kPi, 1e-9);
  EXPECT_NEAR(heading_by_landmark(blue - middle, to_blue.position() - middle,
                                  std::atan2(seen(blue, to_blue).y(), seen(blue, to_blue).x())),
              wrap_angle(3.3), 1e-12);
}

}  // namespace
}  // namespace vigia::localization
