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

using ::testing::HasSubstr;
using vigia::testing::read_text;

class RunFolderTest : public ::testing::Test {
 protected:
  std::filesystem::path drive() const {
    const auto setup = load_mission(
        std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml", {"timeout_s=2"});
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
