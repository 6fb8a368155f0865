#include "ring_drive.hpp"
#include "ring_fix.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

/// The hall with a thin wall across it that leaves a door of @p width round y = 3.
FloorPlan hall_with_narrow_door(double width) {
  return FloorPlan(
      {{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}}, 2.8,
      {{{5.0, 0.0}, {5.0, 3.0 - 0.5 * width}, 2.8}, {{5.0, 3.0 + 0.5 * width}, {5.0, 6.0}, 2.8}},
      {});
}

/// From aside of the door straight through it and on to the other side.
Path through_the_door() {
  return Path({{2.5, 1.0}, {4.38, 3.0}, {5.62, 3.0}, {7.5, 5.0}}).resampled(0.05);
}

const Pose2 kAside{2.5, 1.0, from_deg(47)};

const std::vector<Pose2> kErrors{{0.03, -0.03, from_deg(1.0)},
                                 {-0.03, 0.03, from_deg(-1.0)},
                                 {0.03, 0.03, from_deg(-1.0)},
                                 {0.0, 0.05, from_deg(0.5)}};

TEST(RingFix, FindsTheBaseBesideADoorWithinItsSigma) {
  RandomStream random(3, "errors");
  double nees = 0.0;
  double squared_m2 = 0.0;
  constexpr int kTrials = 100;
  for (int trial = 0; trial < kTrials; ++trial) {
    RingDrive drive(hall_with_narrow_door(0.7), through_the_door(), {4.4, 3.0, 0.0});
    drive.random = RandomStream(static_cast<std::uint64_t>(trial), "ring");
    Belief belief = drive.belief;
    belief.pose = {drive.pose.x + 0.04 * random.normal(), drive.pose.y + 0.04 * random.normal(),
                   from_deg(1.0) * random.normal()};
    belief.covariance = Eigen::Vector3d(0.0016, 0.0016, from_deg(1.0) * from_deg(1.0)).asDiagonal();
    RingFix fix(drive.plan, {});
    fix.begin(belief);
    for (int i = 0; i < 25; ++i) fix.update(drive.scan());
    ASSERT_TRUE(fix.agrees()) << trial;
    const Eigen::Vector3d off(fix.pose().x - drive.pose.x, fix.pose().y - drive.pose.y,
                              wrap_angle(fix.pose().theta - drive.pose.theta));
    nees += off.dot(fix.covariance().ldlt().solve(off)) / kTrials;
    squared_m2 += off.y() * off.y() / kTrials;
  }
  // Each reading's σ counts twice, so that the claim is the larger: NEES is 3/4 of white readings.
  EXPECT_LT(nees, 3.0);
  EXPECT_LT(std::sqrt(squared_m2), 0.008);
}

TEST(RingFix, DoesNotAgreeWhereTheBeliefIsWrong) {
  RingDrive drive(hall_with_narrow_door(0.7), through_the_door(), {4.4, 2.2, 0.4});
  Belief belief = drive.belief;
  belief.pose = {4.4, 3.0, 0.0};
  RingFix fix(drive.plan, {});
  fix.begin(belief);
  for (int i = 0; i < 25; ++i) fix.update(drive.scan());
  EXPECT_FALSE(fix.agrees());
}

TEST(NarrowDoors, ArePassedWithoutTouchingTheFrameHoweverTheBeliefIsOff) {
  for (const double width : {0.65, 0.70, 0.80})
    for (const Pose2& error : kErrors) {
      RingDrive drive(hall_with_narrow_door(width), through_the_door(), kAside);
      drive.belief_error = error;
      EXPECT_TRUE(drive.run(90.0)) << width << " m, " << error.y;
      EXPECT_GT(drive.nearest, 0.0) << width << " m, " << error.y;
    }
}

TEST(NarrowDoors, ArePassedAtASteadySpeed) {
  RingDrive drive(hall_with_narrow_door(0.65), through_the_door(), kAside);
  drive.belief_error = kErrors.front();
  double before = 0.0;
  int ticks = 0;
  while (!drive.pilot.arrived() && drive.seconds < 90.0) {
    drive.tick();
    const bool inside = std::abs(drive.pose.x - 5.0) < 0.4;
    if (inside && ticks++ > 0) {
      EXPECT_LT(std::abs(drive.command.v - before), 0.03) << drive.seconds << " s";
      EXPECT_GT(drive.command.v, 0.05);
    }
    before = drive.command.v;
  }
  EXPECT_GT(ticks, 10);
}

TEST(NarrowDoors, AreRefusedWhereTheClaimedSigmaDoesNotFit) {
  RingDrive drive(hall_with_narrow_door(0.65), through_the_door(), kAside);
  drive.ring = false;  // and σ = 2 cm
  while (!drive.output.refused && drive.seconds < 60.0) drive.tick();
  ASSERT_TRUE(drive.output.refused);
  EXPECT_NEAR(drive.output.refused->width_m, 0.65, 1e-9);
  EXPECT_NEAR(drive.output.refused->beside_m, 0.055, 1e-9);
  EXPECT_NEAR(drive.output.refused->sigma_m, 0.02, 1e-9);
  EXPECT_FALSE(drive.output.refused->misaligned);
  EXPECT_LT(drive.pose.x, 5.0 - RingDrive::kRadius);
  EXPECT_GT(drive.nearest, 0.0);
}

TEST(NarrowDoors, AreRefusedToARobotAsideOfThemThatMayComeAnew) {
  // A path that leads in obliquely.
  RingDrive drive(hall_with_narrow_door(0.70), Path({{3.0, 2.0}, {7.0, 4.0}}).resampled(0.05),
                  {3.0, 2.0, from_deg(26.6)});
  while (!drive.output.refused && !drive.pilot.arrived() && drive.seconds < 60.0) drive.tick();
  ASSERT_TRUE(drive.output.refused);
  EXPECT_TRUE(drive.output.refused->misaligned);
  EXPECT_GT(drive.nearest, 0.0);
}

}  // namespace
}  // namespace vigia::pilot
