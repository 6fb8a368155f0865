#include "vigia/mission/localizers.hpp"

#include "support/temp_dir.hpp"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"

namespace vigia::mission {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

MissionSetup load(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return load_mission(VIGIA_SOURCE_DIR "/config/missions/" + name + ".yaml", overrides);
}

TEST(Localizers, EveryNameMakesTheLocalizerOfThatName) {
  const MissionSetup setup = load("quixote-room");
  for (const LocalizerEntry& entry : localizers())
    EXPECT_EQ(entry.make(setup, 1)->name(), entry.name);
}

TEST(Localizers, AMissionThatNamesNoneHasTheCheapOnesThatSuitRobotAndWorld) {
  EXPECT_THAT(load("armingol-room").localizers, ElementsAre("ekf", "odometry"));
  EXPECT_THAT(load("quixote-room").localizers, ElementsAre("ekf", "odometry", "pattern_fix"));
}

TEST(Localizers, AMissionHasThoseThatItNames) {
  const auto setup = load("armingol-room", {"localization.localizers=[odometry]"});
  EXPECT_THAT(setup.localizers, ElementsAre("odometry"));
  EXPECT_EQ(setup.primary, "odometry");
}

std::string refusal(const std::vector<std::string>& overrides) {
  try {
    load("armingol-room", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Localizers, WithoutAPriorThoseThatCannotStartAreLeftOutOrRefusedByName) {
  const auto setup = load("armingol-room", {"start.prior=false"});
  EXPECT_FALSE(setup.prior);
  EXPECT_THAT(setup.localizers, ElementsAre("ekf"));
  EXPECT_THAT(refusal({"start.prior=false", "localization.localizers=[ekf, odometry]"}),
              AllOf(HasSubstr("'odometry' cannot start without a prior"), HasSubstr("localizers"),
                    HasSubstr("never finds itself"), Not(HasSubstr("primary"))));
  EXPECT_THAT(refusal({"start.prior=false", "localization.localizers=[bearing_only, ekf]",
                       "localization.primary=bearing_only"}),
              HasSubstr("'ekf' cannot start without a prior"));
  EXPECT_EQ(refusal({"start.prior=false", "localization.localizers=[ekf, bearing_only]"}), "");
}

TEST(Localizers, WithoutAHeadThatLooksAroundNobodyFindsHimselfByLooks) {
  const std::string fixed = "robot={name: a, cameras: [{mount: fixed, focal_px: 500}]}";
  for (const std::string name : {"ekf", "bearing_only"})
    EXPECT_THAT(refusal({fixed, "start.prior=false", "localization.localizers=[" + name + "]"}),
                HasSubstr("'" + name + "' cannot start without a prior"));
}

TEST(Localizers, WithoutLandmarksThoseThatNeedThemAreRefused) {
  EXPECT_THAT(refusal({"world.landmarks=[]", "planner.policy=nearest", "localization.primary=ekf"}),
              HasSubstr("'ekf' needs landmarks"));
  // Whom nobody named is left out.
  const auto setup = load("armingol-room", {"world.landmarks=[]", "planner.policy=nearest"});
  EXPECT_EQ(setup.primary, "odometry");
  EXPECT_EQ(refusal({"world.landmarks=[]", "localization.primary=odometry"}), "");
}

TEST(Localizers, ImagesThatComeLaterThanTheyRememberAreRefused) {
  EXPECT_THAT(refusal({"disturbances.latency={latency_s: 0.9, processing_s: 0.2}"}),
              AllOf(HasSubstr("images of camera 0 come up to 1.12 s late"),
                    HasSubstr("'ekf' remembers 1 s (localization.ekf.history_s)")));
  EXPECT_EQ(refusal({"disturbances.latency={latency_s: 0.9, processing_s: 0.2}",
                     "localization.ekf.history_s=2"}),
            "");
}

TEST(Localizers, TheWaitForTheProcessorCounts) {
  // An image every 0.4 s, processed for 0.6 s: the next one waits as long as the one before allows.
  const std::vector<std::string> slow{
      "robot={name: slow, cameras: [{mount: fixed, focal_px: 500, period_s: 0.4}]}",
      "disturbances.latency={latency_s: 0.1, processing_s: 0.6}"};
  EXPECT_THAT(refusal(slow), HasSubstr("images of camera 0 come up to 1.08 s late"));
}

TEST(Localizers, ImagesThatComeLaterThanOneRemembersConcernThoseWhomTheyAreForAlone) {
  const std::string hall =
      "robot={name: up, cameras: [{mount: fixed, mount_m: [0, 0, 0.5], "
      "rpy_deg: [0, -90, 0], focal_px: 500, latency_s: LATE}]}";
  const auto up = [&](const std::string& late) {
    std::string robot = hall;
    return robot.replace(robot.find("LATE"), 4, late);
  };
  const auto refused = [&](const std::string& late, const std::string& flow) {
    try {
      load("ceiling-hall",
           {up(late), "localization.localizers=[ceiling, odometry]", "localization.flow=" + flow});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused("0.9", "[ceiling]"), "");
  EXPECT_THAT(refused("1.2", "[ceiling]"), HasSubstr("'ceiling' remembers 1 s"));
  EXPECT_THAT(refused("0.9", "[odometry]"), HasSubstr("the localizers of `flow` wait 0.5 s"));
  EXPECT_EQ(refused("0.4", "[odometry]"), "");
}

TEST(Localizers, AllTakeTheirNoiseFromTheOneModelUnlessTheirOwnKeysOverrideIt) {
  const auto setup = load("armingol-room", {"localization.noise.sensor.look_angle_deg=0.6",
                                            "localization.noise.centre_floor_px=0.03",
                                            "localization.ekf.sensor.look_angle_deg=0.1"});
  EXPECT_NEAR(setup.noise.sensor.look_angle, from_deg(0.6), 1e-12);
  EXPECT_NEAR(setup.ekf.sensor.look_angle, from_deg(0.1), 1e-12);
  EXPECT_NEAR(setup.ekf.centre_floor_px, 0.03, 1e-12);
  EXPECT_NEAR(setup.bearing_only.sensor.look_angle, from_deg(0.6), 1e-12);
  EXPECT_NEAR(setup.gaze.look_angle, from_deg(0.6), 1e-12);
  EXPECT_NEAR(load("armingol-room", {"gaze.look_angle_deg=1"}).gaze.look_angle, from_deg(1), 1e-12);
}

TEST(Localizers, TheResolvedMissionNamesThem) {
  const auto setup = load("quixote-room", {"localization.primary=pattern_fix"});
  EXPECT_THAT(setup.resolved_yaml, HasSubstr("localizers: [ekf, odometry, pattern_fix]"));
  const testing::TempDir dir;
  std::ofstream(dir.path() / "mission.yaml") << setup.resolved_yaml;
  const auto again = load_mission(dir.path() / "mission.yaml");
  EXPECT_EQ(again.localizers, setup.localizers);
  EXPECT_EQ(again.primary, "pattern_fix");
  EXPECT_EQ(again.resolved_yaml, setup.resolved_yaml);
}

}  // namespace
}  // namespace vigia::mission
