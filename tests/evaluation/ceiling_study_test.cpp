#include "vigia/evaluation/ceiling_study.hpp"

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"

namespace vigia::evaluation {
namespace {

constexpr double kStep_m = 0.12;
constexpr double kStep_s = 1.2;

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
  const CeilingSetting setting;
  const auto frames = read_ceiling_drive(setting, line());
  const auto nearest = summarise_errors(follow_published(setting, setting.known_camera(), frames));
  const auto joint = summarise_errors(fix_jointly(setting, {}, frames));
  EXPECT_LT(nearest.mean_m, 0.003);
  EXPECT_LT(to_deg(nearest.heading_mean), 0.4);
  EXPECT_LT(joint.mean_m, 0.001);
  // Four standard errors of some forty independent frames.
  EXPECT_NEAR(joint.rms_m / joint.bound_m, 1.0, 4.0 / std::sqrt(4.0 * joint.frames));
}

TEST(CeilingStudy, TiltHeightAndPlacementExplainThePublishedErrorAndAreCalibrated) {
  const CeilingSetting setting = tilted_setting();
  const auto frames = read_ceiling_drive(setting, line());
  const auto published =
      summarise_errors(follow_published(setting, setting.known_camera(), frames));
  EXPECT_GT(published.mean_m, 0.02);
  const auto errors = calibrate_ceiling(setting, frames, kStep_s);
  EXPECT_NEAR(to_deg(errors.tilt_x), to_deg(setting.true_errors().tilt_x), 0.15);
  EXPECT_NEAR(to_deg(errors.tilt_y), to_deg(setting.true_errors().tilt_y), 0.15);
  EXPECT_NEAR(errors.log_height, setting.true_errors().log_height, 0.004);
  const auto calibrated = summarise_errors(
      follow_published(setting, corrected(setting.known_camera(), errors), frames));
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
