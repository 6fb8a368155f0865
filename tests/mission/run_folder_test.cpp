#include "vigia/mission/run_folder.hpp"

#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vigia::testing::read_text;

class RunFolderTest : public ::testing::Test {
 protected:
  static MissionSetup room(const std::vector<std::string>& overrides) {
    return load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                        overrides);
  }
  std::filesystem::path drive(const MissionSetup& setup = room({"timeout_s=2"})) const {
    RunFolder recorder(dir_.path() / "run");
    run_mission(setup, 1, {&recorder});
    recorder.folder().commit();
    return dir_.path() / "run";
  }
  vigia::testing::TempDir dir_;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST_F(RunFolderTest, WritesTumTrajectoriesOfExactlyEightColumnsWithoutTrailingBlanks) {
  const auto folder = drive();
  for (const char* name : {"truth.tum", "ekf.tum", "odometry.tum"}) {
    const auto lines = lines_of(read_text(folder / name));
    ASSERT_EQ(lines.size(), 50U) << name;
    double last = -1.0;
    for (const auto& line : lines) {
      EXPECT_EQ(std::count(line.begin(), line.end(), ' '), 7) << line;
      EXPECT_NE(line.back(), ' ');
      const double stamp = std::stod(line);
      EXPECT_GT(stamp, last);
      last = stamp;
    }
  }
}

TEST_F(RunFolderTest, WritesATableWhoseRowsAreAsWideAsItsHeader) {
  const auto lines = lines_of(read_text(drive() / "ticks.csv"));
  ASSERT_EQ(lines.size(), 51U);
  const auto columns = std::count(lines[0].begin(), lines[0].end(), ',');
  for (const auto& line : lines)
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns) << line;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line + ",");
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

TEST_F(RunFolderTest, EndsEachRowWithTheActivationsOfThePilotsBehaviours) {
  const MissionSetup with_stops = room(
      {"timeout_s=10", "planner.trigger={kind: uncertainty, limit_1_m: 0.02, limit_2_m: 0.02}"});
  const auto lines = lines_of(read_text(drive(with_stops) / "ticks.csv"));
  const std::vector<std::string> names = cells_of(lines[0]);
  const std::size_t first = names.size() - 3;
  EXPECT_THAT(
      std::vector<std::string>(names.begin() + static_cast<std::ptrdiff_t>(first), names.end()),
      ElementsAre("activation_follow", "activation_avoid", "activation_hold"));
  const auto stopped =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), "stopped") - names.begin());
  int held = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto cells = cells_of(lines[i]);
    ASSERT_EQ(cells.size(), names.size()) << lines[i];
    // Nothing unknown is about: the path is followed unless somebody looks.
    const bool holds = cells[stopped] == "1";
    held += holds ? 1 : 0;
    EXPECT_EQ(cells[first], holds ? "0.0000" : "1.0000") << i;
    EXPECT_EQ(cells[first + 1], "0.0000") << i;
    EXPECT_EQ(cells[first + 2], holds ? "1.0000" : "0.0000") << i;
  }
  EXPECT_GT(held, 10);
  EXPECT_LT(held, static_cast<int>(lines.size()) - 10);
}

TEST_F(RunFolderTest, LeavesTheActivationsEmptyWhileALostRobotLooksAround) {
  MissionSetup setup = room({"timeout_s=2"});
  setup.ekf.lost_sigma_m = 1e-4;
  const auto lines = lines_of(read_text(drive(setup) / "ticks.csv"));
  ASSERT_GT(lines.size(), 2U);
  EXPECT_THAT(lines.back(), ::testing::EndsWith(",,,"));
  EXPECT_EQ(cells_of(lines.back()).size(), cells_of(lines.front()).size());
}

TEST_F(RunFolderTest, TellsTheStoryFromStartToEnd) {
  const auto lines = lines_of(read_text(drive() / "events.jsonl"));
  EXPECT_THAT(lines.front(), HasSubstr("\"event\":\"start\""));
  EXPECT_THAT(lines.back(), HasSubstr("\"event\":\"timeout\""));
}

TEST_F(RunFolderTest, LeavesNothingWithoutCommit) {
  {
    RunFolder recorder(dir_.path() / "run");
    EXPECT_FALSE(std::filesystem::is_empty(dir_.path()));
  }
  EXPECT_TRUE(std::filesystem::is_empty(dir_.path()));
}

TEST_F(RunFolderTest, RefusesAFolderThatItDidNotMake) {
  std::filesystem::create_directories(dir_.path() / "run/keep");
  EXPECT_THROW(RunFolder(dir_.path() / "run"), InputError);
}

}  // namespace
}  // namespace vigia::mission
