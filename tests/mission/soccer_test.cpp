#include <map>
#include <string>

#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

const std::string kMissions = std::string(VIGIA_SOURCE_DIR) + "/config/missions/";

TEST(SoccerMission, EveryLocalizerKnowsItsPlaceByTheMirrorsPicturesAlone) {
  evaluation::DriveScorer scorer;
  run_mission(load_mission(kMissions + "soccer.yaml", {"timeout_s=4"}), 1, {&scorer});
  const auto& localizers = scorer.score().localizers;
  // Over a minute 0.3 mm, 0.3 mm and 1.4 cm.
  const std::map<std::string, double> most_m{
      {"field_grid", 0.002}, {"mcl", 0.002}, {"murea", 0.04}};
  for (const auto& [name, most] : most_m) {
    EXPECT_LT(localizers.at(name).position_rmse_m, most) << name;
    EXPECT_GT(localizers.at(name).updates, 80) << name;
    EXPECT_EQ(localizers.at(name).unsupported, 0) << name;
  }
  EXPECT_GT(localizers.at("field_grid").pcrlb_position_rms_m, 0.0001);
  EXPECT_LT(localizers.at("field_grid").pcrlb_position_rms_m, 0.002);
}

TEST(SoccerMission, EveryFieldsMissionCanBeRead) {
  for (const char* name : {"soccer", "soccer-16x10", "soccer-msl"})
    EXPECT_TRUE(load_mission(kMissions + name + ".yaml").world.field) << name;
}

TEST(SoccerMission, ALocalizerForLandmarksIsRefused) {
  try {
    load_mission(kMissions + "soccer.yaml", {"localization.localizers=[ekf]"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'ekf' needs landmarks"), std::string::npos)
        << error.what();
  }
}

TEST(SoccerMission, AMirrorNeedsToBeInColour) {
  try {
    load_mission(kMissions + "soccer.yaml",
                 {"robot={name: grey, cameras: [{mount: fixed, optics: omni, focal_px: 200}]}"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("colour: true"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace vigia::mission
