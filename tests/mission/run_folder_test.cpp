#include "vigia/mission/run_folder.hpp"

#include "support/process.hpp"
#include "support/temp_dir.hpp"
#include "tum.hpp"

#include <algorithm>
#include <cmath>
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

TEST(TumLine, IsInThreeDimensionsOnASlope) {
  Eigen::Isometry3d wMg = Eigen::Isometry3d::Identity();
  wMg.linear() = Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  wMg.translation().z() = 0.5;
  std::istringstream line(tum_line(Stamp::from_seconds(1.5), {2.0, 1.0, 0.0}, Ground(wMg)));
  std::vector<double> values;
  for (double value = 0.0; line >> value;) values.push_back(value);
  ASSERT_EQ(values.size(), 8U);
  EXPECT_NEAR(values[1], 2.0 * std::cos(0.1), 1e-6);
  EXPECT_NEAR(values[3], 0.5 + 2.0 * std::sin(0.1), 1e-6);
  EXPECT_NEAR(values[5], -std::sin(0.05), 1e-9);
  EXPECT_NEAR(values[7], std::cos(0.05), 1e-9);
  EXPECT_EQ(tum_line(Stamp::from_seconds(1.5), {2.0, 1.0, 0.0}, {}),
            "1.500000 2.000000 1.000000 0 0 0 0.000000000 1.000000000\n");
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

/// Where a column of this name stands.
std::size_t column(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

TEST_F(RunFolderTest, WritesTheActivationsOfThePilotsBehaviours) {
  const MissionSetup with_stops = room(
      {"timeout_s=10", "planner.trigger={kind: uncertainty, limit_1_m: 0.02, limit_2_m: 0.02}"});
  const auto lines = lines_of(read_text(drive(with_stops) / "ticks.csv"));
  const std::vector<std::string> names = cells_of(lines[0]);
  int held = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto cells = cells_of(lines[i]);
    ASSERT_EQ(cells.size(), names.size()) << lines[i];
    // Nothing unknown is about: the path is followed unless somebody looks.
    const bool holds = cells[column(names, "stopped")] == "1";
    held += holds ? 1 : 0;
    EXPECT_EQ(cells[column(names, "activation_follow")], holds ? "0.0000" : "1.0000") << i;
    EXPECT_EQ(cells[column(names, "activation_avoid")], "0.0000") << i;
    EXPECT_EQ(cells[column(names, "activation_hold")], holds ? "1.0000" : "0.0000") << i;
  }
  EXPECT_GT(held, 10);
  EXPECT_LT(held, static_cast<int>(lines.size()) - 10);
}

TEST_F(RunFolderTest, LeavesTheActivationsEmptyWhileALostRobotLooksAround) {
  MissionSetup setup = room({"timeout_s=2"});
  setup.ekf.lost_sigma_m = 1e-4;
  const auto lines = lines_of(read_text(drive(setup) / "ticks.csv"));
  ASSERT_GT(lines.size(), 2U);
  const auto names = cells_of(lines.front());
  const auto cells = cells_of(lines.back());
  ASSERT_EQ(cells.size(), names.size());
  for (const char* name : {"activation_follow", "activation_avoid", "activation_hold"})
    EXPECT_EQ(cells[column(names, name)], "") << name;
}

TEST_F(RunFolderTest, EndsEachRowWithHowSureEachLocalizerIsOfNotBeingLost) {
  const MissionSetup setup = room({"timeout_s=2"});
  const auto lines = lines_of(read_text(drive(setup) / "ticks.csv"));
  const auto names = cells_of(lines.front());
  ASSERT_EQ(names.back(), setup.localizers.back() + "_hypotheses");
  for (const auto& name : setup.localizers) {
    const auto cells = cells_of(lines.back());
    const double probability = std::stod(cells[column(names, name + "_lost_probability")]);
    EXPECT_GE(probability, 0.0) << name;
    EXPECT_LT(probability, 0.5) << name;
    EXPECT_EQ(cells[column(names, name + "_hypotheses")], "0") << name;
  }
}

TEST_F(RunFolderTest, LogsEventsFromStartToEnd) {
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
