#include "vigia/mission/localizers.hpp"

#include "support/temp_dir.hpp"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vigia::mission {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

MissionSetup load(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return load_mission(VIGIA_SOURCE_DIR "/config/missions/" + name + ".yaml", overrides);
}

TEST(Localizers, EveryNameMakesTheLocalizerOfThatName) {
  const MissionSetup setup = load("quixote-room");
  for (const LocalizerEntry& entry : localizers()) EXPECT_EQ(entry.make(setup)->name(), entry.name);
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
