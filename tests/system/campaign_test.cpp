#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace vigia {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using vigia::testing::read_text;

constexpr int kMissions = 120;

class CampaignProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(file_) << "version: 1\nname: short\nmission: " << VIGIA_SOURCE_DIR
                         << "/config/missions/armingol-room-qvga.yaml\n"
                         << "set: [timeout_s=1, planner.trigger.distance_m=0]\n"
                         << "policies: [nearest, random]\nseeds: {count: " << kMissions / 2
                         << "}\n";
  }
  vigia::testing::ProcessResult evaluate(const fs::path& out, const std::string& more = "") const {
    return vigia::testing::run_process(std::string(VIGIA_PROGRAM) + " evaluate " + file_.string() +
                                           " --quiet -j 2 --out " + out.string() + " " + more,
                                       dir_.path());
  }
  /// Starts the real program, kills it once the journal has @p lines lines, and returns how it
  /// ended.
  int kill_at(const fs::path& out, int lines) const {
    const std::string file = file_.string();
    const std::string folder = out.string();
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl(VIGIA_PROGRAM, "vigia", "evaluate", file.c_str(), "--quiet", "-j", "2", "--out",
              folder.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    }
    int status = 0;
    while (journal_lines(out) < lines && ::waitpid(child, &status, WNOHANG) == 0)
      std::this_thread::yield();
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    return status;
  }
  static int journal_lines(const fs::path& out) {
    const std::string text = read_text(out / "journal.jsonl");
    return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  }
  vigia::testing::TempDir dir_;
  fs::path file_ = dir_.path() / "short.yaml";
};

TEST_F(CampaignProgram, KilledThreeTimesItEndsWithTheSameBytes) {
  const fs::path whole = dir_.path() / "whole";
  const fs::path killed = dir_.path() / "killed";
  const auto straight = evaluate(whole);
  ASSERT_EQ(straight.status, 1) << straight.err;  // after one second nobody has arrived
  for (const int lines : {1, kMissions / 3, 2 * kMissions / 3}) {
    const int status = kill_at(killed, lines);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the program ended before it was killed";
    ASSERT_GE(journal_lines(killed), lines);
    ASSERT_FALSE(fs::exists(killed / "summary.json"));
  }
  const auto resumed = evaluate(killed);
  ASSERT_EQ(resumed.status, 1) << resumed.err;
  for (const char* name : {"results.csv", "summary.json", "table.md", "arms.png"})
    EXPECT_EQ(read_text(killed / name), read_text(whole / name)) << name;
  EXPECT_EQ(journal_lines(killed), kMissions);
  std::vector<std::string> lines[2];
  for (const fs::path& folder : {whole, killed}) {
    std::ifstream journal(folder / "journal.jsonl");
    auto& of_folder = lines[folder == whole ? 0 : 1];
    for (std::string line; std::getline(journal, line);) of_folder.push_back(line);
    std::sort(of_folder.begin(), of_folder.end());
  }
  EXPECT_EQ(lines[0], lines[1]);
}

TEST_F(CampaignProgram, RefusesTheFolderOfAnotherMissionAndBeginsAnewWhenTold) {
  const fs::path out = dir_.path() / "out";
  ASSERT_EQ(evaluate(out).status, 1);
  const auto other = evaluate(out, "--set planner.dwell_s=2");
  EXPECT_EQ(other.status, 2);
  EXPECT_EQ(other.out, "");
  EXPECT_THAT(other.err, HasSubstr("\"dwell_s: 1\" there, \"dwell_s: 2\" now"));
  EXPECT_EQ(evaluate(out, "--set planner.dwell_s=2 --restart").status, 1);
}

TEST_F(CampaignProgram, PrintsTheSummaryAndNothingElseOnStdoutWithJson) {
  const fs::path out = dir_.path() / "out";
  const fs::path csv = dir_.path() / "rows.csv";
  const auto result = evaluate(out, "--json --csv " + csv.string());
  EXPECT_EQ(nlohmann::json::parse(result.out)["arms"].size(), 2u);
  EXPECT_EQ(result.out, read_text(out / "summary.json"));
  EXPECT_EQ(read_text(csv), read_text(out / "results.csv"));
  EXPECT_EQ(result.err, "");
}

}  // namespace
}  // namespace vigia
