#include "vigia/evaluation/ceiling_study.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"

namespace vigia::evaluation {
namespace {

constexpr double kStep_m = 0.12;
constexpr double kStep_s = 0.6;

CeilingSetting tilted_setting() {
  CeilingSetting setting;
  setting.tilt = from_deg(1.0);
  setting.tilt_axis = 0.5;
  setting.height_error = 0.02;
  setting.ceiling.grid.placement_m = 0.005;
  setting.ceiling.grid.placement_turn = from_deg(1.3);
  return setting;
}

std::vector<Pose2> line() {
  return straight_poses({0.1, 0.2}, {4.1, 2.2}, kStep_m);
}

TEST(CeilingStudy, AnIdealCameraIsRightToMillimetresByOnePatchAndToTheBoundByAll) {
  CeilingSetting setting;
  setting.contrast = 0.0;
  const auto frames = read_ceiling_drive(setting, line());
  const auto nearest = summarise_errors(follow_published(setting, setting.known_camera(), frames));
  const auto joint = summarise_errors(fix_jointly(setting, {}, frames));
  EXPECT_LT(nearest.mean_m, 0.003);
  EXPECT_LT(to_deg(nearest.heading_mean), 0.4);
  EXPECT_LT(joint.mean_m, 0.001);
  // Four standard errors of some forty independent frames.
  EXPECT_NEAR(joint.rms_m / joint.bound_m, 1.0, 4.0 / std::sqrt(4.0 * joint.frames));
  EXPECT_NEAR(joint.nees, 1.0, 4.0 * std::sqrt(2.0 / (3.0 * joint.frames)));
}

TEST(CeilingStudy, TextureUnderThePatchesCostsLessThanATenthOfAMillimetre) {
  const CeilingSetting setting;
  const auto joint =
      summarise_errors(fix_jointly(setting, {}, read_ceiling_drive(setting, line())));
  EXPECT_LT(joint.mean_m, 1e-4);
}

TEST(CeilingStudy, TheFilterIsAsFarOffAsItsBoundAndItsCovarianceSayWithConstantErrors) {
  constexpr int kDrives = 12;
  double square = 0.0;
  double bound = 0.0;
  double nees = 0.0;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    RandomStream random(seed, "constants");
    CeilingSetting setting = tilted_setting();
    setting.seed = setting.ceiling.seed = seed;
    const Eigen::Vector2d tilt(random.normal(), random.normal());
    setting.tilt = from_deg(0.7) * tilt.norm();
    setting.tilt_axis = std::atan2(tilt.y(), tilt.x());
    setting.height_error = 0.02 * random.normal();
    localization::CeilingFilterParams params;
    params.tilt_sigma = from_deg(0.7);
    params.height_sigma = 0.02;
    const auto followed = summarise_errors(follow_jointly(
        setting, params, read_ceiling_drive(setting, line()), CeilingMotion::unknown, kStep_s));
    square += followed.rms_m * followed.rms_m;
    bound += followed.bound_m * followed.bound_m;
    nees += followed.nees / kDrives;
  }
  // What is constant makes a drive's errors one: some six independent numbers of each. Four
  // standard errors.
  const double slack = 4.0 * std::sqrt(2.0 / (6.0 * kDrives));
  EXPECT_NEAR(square / bound, 1.0, slack);
  EXPECT_NEAR(nees, 1.0, slack);
}

TEST(CeilingStudy, TiltHeightAndPlacementExplainThePublishedErrorAndAreCalibrated) {
  const CeilingSetting setting = tilted_setting();
  const auto frames = read_ceiling_drive(setting, line());
  const auto published =
      summarise_errors(follow_published(setting, setting.known_camera(), frames));
  EXPECT_GT(published.mean_m, 0.02);
  const CeilingCalibration found = calibrate_ceiling(setting, frames, kStep_s);
  const Eigen::Vector3d off = found.errors.vector() - setting.true_errors().vector();
  // The 99.9 % quantile of χ² with three degrees of freedom.
  EXPECT_LT(off.dot(found.covariance.ldlt().solve(off)), 16.27);
  EXPECT_LT(to_deg(std::sqrt(found.covariance(0, 0))), 0.2);
  EXPECT_LT(to_deg(std::sqrt(found.covariance(1, 1))), 0.2);
  EXPECT_LT(std::sqrt(found.covariance(2, 2)), 0.003);
  const auto calibrated = summarise_errors(
      follow_published(setting, corrected(setting.known_camera(), found.errors), frames));
  EXPECT_LT(calibrated.mean_m, 0.5 * published.mean_m);
}

TEST(CeilingStudy, BurstsHideOrDisplaceThePatchesOfTheirFramesAlone) {
  const CeilingSetting setting;
  const auto frames = read_ceiling_drive(setting, straight_poses({0.0, 0.0}, {0.5, 0.0}, 0.1));
  const auto unseen = with_bursts(setting, frames, CeilingFault::unseen, {{1, 2}}, 1);
  const auto misread = with_bursts(setting, frames, CeilingFault::misread, {{1, 2}}, 1);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool hit = i == 1 || i == 2;
    EXPECT_EQ(unseen[i].scan.patches.empty(), hit);
    EXPECT_EQ(misread[i].scan.patches.front().uv != frames[i].scan.patches.front().uv, hit);
  }
}

}  // namespace
}  // namespace vigia::evaluation
