#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/localizers.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

const std::string kMirosot = std::string(VIGIA_SOURCE_DIR) + "/config/missions/mirosot.yaml";

/// What loading the mission with @p overrides says is wrong.
std::string refusal(const std::vector<std::string>& overrides) {
  try {
    load_mission(kMirosot, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MirosotMission, TheRobotKnowsItsPlaceByTheGoalsCorners) {
  evaluation::DriveScorer scorer;
  run_mission(load_mission(kMirosot, {"timeout_s=15"}), 1, {&scorer});
  const auto& localizers = scorer.score().localizers;
  const auto& ml = localizers.at("ml_fix");
  const auto& odometry = localizers.at("odometry");
  EXPECT_GT(ml.updates, 20);
  EXPECT_EQ(ml.unsupported, 0);
  EXPECT_LT(ml.position_rmse_m, 0.03);
  EXPECT_LT(ml.pcrlb_position_rms_m, odometry.pcrlb_position_rms_m);
  EXPECT_GT(ml.pcrlb_position_rms_m, 0.002);
  EXPECT_GT(localizers.at("running_fix").updates, 2);
  EXPECT_EQ(odometry.unsupported, ml.updates + ml.rejected);
}

TEST(MirosotMission, CalibrationErrorsThatTheRobotDoesNotKnowOfCostIt) {
  evaluation::DriveScorer scorer;
  run_mission(load_mission(kMirosot, {"timeout_s=15", "localization.noise.stereo={}",
                                      "disturbances.stereo={baseline: 0.1}"}),
              1, {&scorer});
  EXPECT_GT(scorer.score().localizers.at("ml_fix").nees_mean, 6.0);
}

TEST(MirosotMission, ItsLocalizersNeedAPairOfCameras) {
  const std::string one = "robot={name: one, cameras: [{mount: fixed, focal_px: 500}]}";
  EXPECT_THAT(refusal({one, "localization.localizers=[ml_fix]", "localization.primary=ml_fix"}),
              ::testing::HasSubstr(
                  "'ml_fix' needs a field with goals in the world, and a level stereo pair"));
}

TEST(MirosotMission, APairThatDoesNotExposeTogetherIsNone) {
  EXPECT_THAT(
      refusal(
          {"robot={name: two, cameras: [{mount: fixed, mount_m: [0, 0.03, 0.1], focal_px: 500}, "
           "{id: 1, mount: fixed, mount_m: [0, -0.03, 0.1], focal_px: 500, latency_s: 0.1}]}",
           "localization.localizers=[ml_fix]", "localization.primary=ml_fix"}),
      ::testing::HasSubstr("'ml_fix' needs"));
}

TEST(MirosotMission, ARunningFixNeedsAPrior) {
  EXPECT_THAT(refusal({"start.prior=false"}), ::testing::HasSubstr("cannot start without a prior"));
}

}  // namespace
}  // namespace vigia::mission
