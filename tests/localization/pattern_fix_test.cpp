#include "vigia/localization/pattern_fix.hpp"

#include "localization/points_drive.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace vigia::localization {
namespace {

/// On the wall x = 6, above the camera.
const Landmark kFixPattern = test::pattern(4, 6.0, 3.9, 2.15, 180.0);
const HeadGeometry kHead{{0.2, 0.05, 1.1}, 0.1, {0.03, 0.01, 0.02}};

/// A robot on a ramp: 0.25 m up, its front 6° up, its left 2° down.
Eigen::Isometry3d on_the_ramp() {
  Eigen::Isometry3d wMr = to_isometry({3.2, 2.4, 0.5}, 0.25);
  wMr.linear() = wMr.linear() *
                 Eigen::AngleAxisd(from_deg(-6.0), Eigen::Vector3d::UnitY()).toRotationMatrix() *
                 Eigen::AngleAxisd(from_deg(-2.0), Eigen::Vector3d::UnitX()).toRotationMatrix();
  return wMr;
}

PointsObservation seen_from(const Eigen::Isometry3d& wMr, const Landmark& landmark,
                            const LookBias& bias, double sigma, RandomStream& random,
                            Stamp stamp = {}) {
  Shot shot;
  shot.stamp = stamp;
  shot.look = 1;
  const HeadAngles aim = aim_at(kHead, wMr.inverse() * landmark.centre_w());
  shot.head = {aim.pan - bias.pan, aim.tilt - bias.tilt};
  shot.model = test::zoom_calibration().at(30.0);
  return test::observe_points(landmark, shot, kHead, wMr, bias, 0.0, sigma, random);
}

PatternFixLocalizer localizer(const PatternFixParams& params = {}) {
  return PatternFixLocalizer(LandmarkMap({kFixPattern}), {head_rig(kHead), {}}, params);
}

TEST(PatternFix, OneImageOnARampGivesTheWholePose) {
  RandomStream random(1, "unused");
  PatternFixLocalizer fix = localizer();
  ASSERT_EQ(fix.update(seen_from(on_the_ramp(), kFixPattern, {}, 0.0, random)).status,
            UpdateStatus::fused);
  ASSERT_TRUE(fix.belief().in_space);
  EXPECT_TRUE(fix.belief().in_space->wMr.isApprox(on_the_ramp(), 1e-6));
  const FloorAttitude floor = floor_attitude(*fix.belief().in_space);
  EXPECT_NEAR(floor.z_m, 0.25, 1e-6);
  EXPECT_NEAR(floor.pitch, from_deg(6.0), 1e-6);
  EXPECT_NEAR(to_deg(floor.roll), -2.0, 0.02);  // the left's rise: 2° times cos 6°
  EXPECT_NEAR(fix.belief().pose.x, 3.2, 1e-6);
  EXPECT_NEAR(fix.belief().pose.y, 2.4, 1e-6);
}

TEST(PatternFix, ItsCovarianceIsThatOfItsErrorsWithHeadAndFocalErrorIncluded) {
  constexpr int kRuns = 1000;
  RandomStream random(3, "ramp");
  PatternFixParams params;
  params.sensor.reading_angle = from_deg(0.1);
  PatternFixLocalizer fix = localizer(params);
  double nees = 0.0;
  double attitude_nees = 0.0;
  const FloorAttitude truth = floor_attitude({on_the_ramp(), {}});
  for (int i = 0; i < kRuns; ++i) {
    LookBias bias = test::draw_bias(random, params.sensor);
    bias.pan += params.sensor.reading_angle * random.normal();
    bias.tilt += params.sensor.reading_angle * random.normal();
    fix.reset({}, Prior{});
    PointsObservation seen = seen_from(on_the_ramp(), kFixPattern, bias, 0.2, random);
    ASSERT_NE(fix.update(seen).status, UpdateStatus::unsupported);
    const SpatialPose& pose = *fix.belief().in_space;
    Eigen::Matrix<double, 6, 1> e;
    const Eigen::AngleAxisd turn(
        Eigen::Matrix3d(on_the_ramp().linear() * pose.wMr.linear().transpose()));
    e << on_the_ramp().translation() - pose.wMr.translation(), turn.angle() * turn.axis();
    nees += e.dot(pose.covariance.ldlt().solve(e)) / kRuns;
    const FloorAttitude floor = floor_attitude(pose);
    const Eigen::Vector3d off(floor.z_m - truth.z_m, floor.pitch - truth.pitch,
                              floor.roll - truth.roll);
    attitude_nees += off.dot(floor.covariance.ldlt().solve(off)) / kRuns;
  }
  // Four standard errors of a mean of χ² of 6 and of 3 dof, and 1 in 1000 gated away.
  EXPECT_NEAR(nees, 6.0, 4.0 * std::sqrt(12.0 / kRuns));
  EXPECT_NEAR(attitude_nees, 3.0, 4.0 * std::sqrt(6.0 / kRuns));
}

TEST(PatternFix, HoldsWithOdometryBetweenLooksAlongTheRamp) {
  RandomStream random(1, "unused");
  PatternFixLocalizer fix = localizer();
  fix.update(seen_from(on_the_ramp(), kFixPattern, {}, 0.0, random));
  const double before = fix.belief().position_sigma();
  fix.predict({{}, Stamp::from_seconds(1.0), 0.0, 0.5, 0.0});
  const Eigen::Isometry3d expected =
      on_the_ramp() * Eigen::Translation3d(Eigen::Vector3d(0.5, 0.0, 0.0));
  EXPECT_TRUE(fix.belief().in_space->wMr.isApprox(expected, 1e-6));
  EXPECT_NEAR(floor_attitude(*fix.belief().in_space).z_m, 0.25 + 0.5 * std::sin(from_deg(6.0)),
              1e-6);
  EXPECT_GT(fix.belief().position_sigma(), before);
}

TEST(PatternFix, ALateImageIsMovedToThePresent) {
  RandomStream random(1, "unused");
  PatternFixLocalizer fix = localizer();
  const auto drive = [](double from, double to) {
    return arc_increment(0.3, 0.4, Stamp::from_seconds(from), Stamp::from_seconds(to));
  };
  fix.reset({}, Prior{});
  fix.predict(drive(0.0, 0.2));
  fix.predict(drive(0.2, 0.4));
  const auto late =
      seen_from(on_the_ramp(), kFixPattern, {}, 0.0, random, Stamp::from_seconds(0.1));
  ASSERT_EQ(fix.update(late).status, UpdateStatus::fused);
  const Eigen::Isometry3d moved_on =
      on_the_ramp() *
      to_isometry(move(Pose2{}, arc_increment(0.3, 0.4, {}, Stamp::from_seconds(0.3))));
  EXPECT_TRUE(fix.belief().in_space->wMr.isApprox(moved_on, 1e-6));
  EXPECT_EQ(fix.belief().stamp, Stamp::from_seconds(0.4));

  const auto ahead =
      seen_from(on_the_ramp(), kFixPattern, {}, 0.0, random, Stamp::from_seconds(0.5));
  ASSERT_EQ(fix.update(ahead).status, UpdateStatus::fused);
  fix.predict(drive(0.4, 0.6));
  const Eigen::Isometry3d a_bit_on =
      on_the_ramp() *
      to_isometry(move(Pose2{}, arc_increment(0.3, 0.4, {}, Stamp::from_seconds(0.1))));
  EXPECT_TRUE(fix.belief().in_space->wMr.isApprox(a_bit_on, 1e-6));
}

TEST(PatternFix, OlderThanItsHistoryIsTooLate) {
  RandomStream random(1, "unused");
  PatternFixLocalizer fix = localizer();
  fix.reset({}, Prior{});
  for (int i = 0; i < 30; ++i)
    fix.predict({Stamp::from_seconds(0.1 * i), Stamp::from_seconds(0.1 * (i + 1)), 0, 0.01, 0});
  const auto old = seen_from(on_the_ramp(), kFixPattern, {}, 0.0, random, Stamp::from_seconds(0.5));
  EXPECT_EQ(fix.update(old).status, UpdateStatus::too_late);
}

TEST(PatternFix, CountsWhatItCannotUse) {
  RandomStream random(1, "unused");
  const Landmark tag = test::tag(7, 6.0, 2.9, 2.15, 180.0);
  const Landmark frontal = test::pattern(8, 6.0, 2.4, 1.3, 180.0);
  PatternFixLocalizer fix(LandmarkMap({kFixPattern, tag, frontal}), {head_rig(kHead), {}}, {});
  EXPECT_EQ(fix.update(EllipseObservation{}).status, UpdateStatus::unsupported);
  const Eigen::Isometry3d wMr = to_isometry({3.2, 2.4, 0.1});
  EXPECT_EQ(fix.update(seen_from(wMr, tag, {}, 0.0, random)).status, UpdateStatus::unsupported);
  EXPECT_EQ(fix.update(seen_from(wMr, frontal, {}, 0.0, random)).status, UpdateStatus::degenerate);
  PointsObservation unknown = seen_from(wMr, kFixPattern, {}, 0.0, random);
  unknown.landmark = 99;
  EXPECT_EQ(fix.update(unknown).status, UpdateStatus::gated);
  PointsObservation astray = seen_from(wMr, kFixPattern, {}, 0.1, random);
  astray.points[5].uv.x() += 2.0;
  EXPECT_EQ(fix.update(astray).status, UpdateStatus::gated);
  EXPECT_EQ(fix.count(UpdateStatus::unsupported), 2);
  EXPECT_EQ(fix.count(UpdateStatus::gated), 2);
  EXPECT_EQ(fix.count(UpdateStatus::fused), 0);
}

TEST(PatternFix, OfViewAndTwinTheOneThatStandsUprightIsTaken) {
  RandomStream random(9, "far");
  const Eigen::Isometry3d wMr = to_isometry({1.0, 1.5, 0.2});
  PatternFixLocalizer fix = localizer();
  int fused = 0;
  for (int i = 0; i < 50; ++i) {
    if (fix.update(seen_from(wMr, kFixPattern, {}, 1.0, random)).status != UpdateStatus::fused)
      continue;
    ++fused;
    EXPECT_GT(fix.belief().in_space->wMr.linear()(2, 2), std::cos(from_deg(15.0)));
    EXPECT_LT((fix.belief().pose.position() - Eigen::Vector2d(1.0, 1.5)).norm(), 0.8);
  }
  EXPECT_GT(fused, 25);
}

}  // namespace
}  // namespace vigia::localization
