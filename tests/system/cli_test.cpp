#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "vigia/core/config.hpp"

namespace vigia {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kMission = std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml";

class Program : public ::testing::Test {
 protected:
  vigia::testing::ProcessResult vigia(const std::string& arguments) const {
    return vigia::testing::run_process(std::string(VIGIA_PROGRAM) + " " + arguments, dir_.path());
  }
  fs::path file(const std::string& name, const std::string& text) const {
    std::ofstream(dir_.path() / name) << text;
    return dir_.path() / name;
  }
  vigia::testing::TempDir dir_;
};

/// A mission that ends after two seconds, quickly.
std::string short_run(const fs::path& out) {
  return "run " + kMission + " --quiet --set timeout_s=2 --out " + out.string();
}

TEST_F(Program, WithoutACommandIsWrongUsage) {
  EXPECT_EQ(vigia("").status, 2);
}

TEST_F(Program, SaysThatItsOutputWasNotTaken) {
  const fs::path full = "/dev/full";
  if (!fs::exists(full)) GTEST_SKIP() << full << " is not there";
  for (const std::string& command :
       {std::string("help keys"), short_run(dir_.path() / "run") + " --json --no-pictures",
        short_run(dir_.path() / "run") + " --no-pictures"}) {
    const auto result = vigia(command + " >" + full.string());
    EXPECT_EQ(result.status, 2) << command;
    EXPECT_THAT(result.err, HasSubstr("standard output")) << command;
  }
}

struct WrongUsage {
  const char* name;
  const char* arguments;
  const char* message;  ///< part of what is said
};

void PrintTo(const WrongUsage& usage, std::ostream* out) {
  *out << usage.name;
}

class WrongUsages : public Program, public ::testing::WithParamInterface<WrongUsage> {};

TEST_P(WrongUsages, IsNamedWithTheNearestWordThatThereIs) {
  const auto result = vigia(GetParam().arguments);
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Words, WrongUsages,
    ::testing::Values(
        WrongUsage{"Command", "rn x.yaml",
                   "unknown command 'rn'; did you mean 'run'? (commands: run, plan, check, "},
        WrongUsage{"CommandLikeNone", "quixotize", "unknown command 'quixotize' (commands: run"},
        WrongUsage{"KindOfLandmark", "landmark dsc -o x.pdf",
                   "unknown command 'dsc'; did you mean 'disc'? (commands: disc, pattern, tag, "
                   "ceiling)"},
        WrongUsage{"Option", "run x.yaml --sede=3",
                   "unknown option '--sede'; did you mean '--seed'? (options: --help, --seed"},
        WrongUsage{"Argument", "check a.yaml b.yaml", "'b.yaml' is one argument too many"},
        WrongUsage{"Tracker", "track --tracker dics x.png",
                   "found 'dics', must be one of disc, ellipse, correlation, pattern, tag, "
                   "field_scan, ceiling; did you "
                   "mean 'disc'?"},
        WrongUsage{"Policy", "plan x.yaml --policy nearst",
                   "found 'nearst', must be one of fixed, random, nearest, greedy, fuzzy, pattern; "
                   "did you mean 'nearest'?"},
        WrongUsage{"Topic", "help keyz", "there is no help on 'keyz'; did you mean 'keys'?"},
        WrongUsage{"Key", "help keys planner.trigger.distanc_m",
                   "there is no key 'planner.trigger.distanc_m'; did you mean "
                   "'planner.trigger.distance_m'?"}),
    [](const auto& usage) { return usage.param.name; });

TEST_F(Program, ExplainsACommandOrAllOfThem) {
  const auto all = vigia("help");
  EXPECT_EQ(all.status, 0);
  for (const char* word : {"run", "evaluate", "reproduce", "keys", "localizers", "policies"})
    EXPECT_THAT(all.out, HasSubstr(word));
  EXPECT_THAT(vigia("help plan").out, HasSubstr("--policy"));
}

TEST_F(Program, ExplainsEveryKeyThatAResolvedMissionHas) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "run")).status, 1);
  const auto keys = nlohmann::json::parse(vigia("help keys --json").out);
  std::set<std::string> known;
  for (const auto& row : keys) known.insert(row["key"].get<std::string>());
  const auto root = load_config(dir_.path() / "run/mission.yaml");
  const std::function<void(const ConfigNode&, const std::string&)> visit =
      [&](const ConfigNode& node, const std::string& path) {
        EXPECT_TRUE(path.empty() || known.count(path) == 1) << path;
        for (const auto& [key, value] : node.entries)
          visit(*value, path.empty() ? key : path + "." + key);
        for (const auto& item : node.items)
          if (item->kind == ConfigNode::Kind::map)
            for (const auto& [key, value] : item->entries) visit(*value, path + "[]." + key);
      };
  visit(*root, "");
}

TEST_F(Program, GivesUnitRangeAndDefaultOfAKey) {
  const auto keys = nlohmann::json::parse(vigia("help keys world.room.height_m --json").out);
  ASSERT_EQ(keys.size(), 1U);
  EXPECT_EQ(keys[0]["unit"], "m");
  EXPECT_EQ(keys[0]["range"], "0.05 … 100");
  EXPECT_EQ(keys[0]["default"], "2.8");
  EXPECT_THAT(vigia("help keys planner.trigger").out, HasSubstr("planner.trigger.limit_2_m"));
}

TEST_F(Program, ExplainsTheKeysOfAListsItems) {
  for (const std::string path : {"robot.cameras", "robot.cameras[]", "robot.cameras[0]"}) {
    const auto result = vigia("help keys '" + path + "'");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("robot.cameras[].period_s")) << path;
  }
  EXPECT_THAT(vigia("help keys 'robot.cameras[1].phase_s'").out,
              HasSubstr("of the first exposure"));
}

TEST_F(Program, TellsLocalizersTrackersAndPoliciesApart) {
  EXPECT_THAT(vigia("help localizers").out, HasSubstr("dead reckoning alone"));
  EXPECT_THAT(vigia("help trackers").out, HasSubstr("AprilTags of the family 36h11"));
  EXPECT_THAT(vigia("help policies").out, HasSubstr("the nearest visible landmark"));
}

TEST_F(Program, HasTheTablesOfKeysThatThePagesShow) {
  const auto result = vigia::testing::run_process(
      std::string(VIGIA_SOURCE_DIR) + "/.ci/check-key-tables " + VIGIA_PROGRAM, dir_.path());
  EXPECT_EQ(result.status, 0) << result.out << result.err;
}

TEST_F(Program, WritesItsManualPageWithEveryCommandAndOption) {
  const auto page = vigia("help man");
  ASSERT_EQ(page.status, 0) << page.err;
  EXPECT_THAT(page.out, ::testing::StartsWith(".TH VIGIA 1 "));
  for (const char* words : {".SS \"vigia run\"", ".SS \"vigia campaign run\\-shard\"",
                            "\\fB\\-\\-no\\-report\\fR", "(default: ", ".SH \"EXIT STATUS\""})
    EXPECT_THAT(page.out, HasSubstr(words));
  // A line that begins with a point is a request; nothing else may.
  std::istringstream lines(page.out);
  const std::set<std::string> requests{".TH", ".SH", ".SS", ".TP", ".PP", ".nf", ".fi"};
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || (line.front() != '.' && line.front() != '\'')) continue;
    EXPECT_EQ(requests.count(line.substr(0, line.find(' '))), 1U) << line;
  }
}

TEST_F(Program, CompletesCommandsAndOptionsInBash) {
  const auto script = vigia("help completion");
  ASSERT_EQ(script.status, 0) << script.err;
  const fs::path completion = file("completion", script.out);
  const auto completed = [&](const std::string& line) {
    const fs::path asked =
        file("ask.sh", ". " + completion.string() + "\nCOMP_WORDS=(vigia " + line +
                           ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_vigia\n"
                           "echo \"${COMPREPLY[*]}\"\n");
    return vigia::testing::run_process("bash " + asked.string(), dir_.path()).out;
  };
  EXPECT_EQ(completed("ru"), "run\n");
  EXPECT_EQ(completed("campaign ''"), "plan run-shard status merge\n");
  EXPECT_EQ(completed("run x.yaml --se"), "--seed --set\n");
  EXPECT_EQ(completed("landmark tag --i"), "--id\n");
  EXPECT_EQ(completed("run con"), "\n");
}

TEST_F(Program, TellsItsVersion) {
  const auto result = vigia("--version");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("0.1.0"));
}

TEST_F(Program, ChecksTheMissionThatItComesWith) {
  const auto result = vigia("check " + kMission);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("armingol-room"));
  EXPECT_THAT(result.out, HasSubstr("m beside the robot at ["));
}

TEST_F(Program, ChecksEveryKindOfFileThatItComesWith) {
  const std::string config = std::string(VIGIA_SOURCE_DIR) + "/config";
  for (const auto& [file, said] :
       {std::pair{"/missions/tag-room.yaml", "a mission, \"tag-room\""},
        {"/worlds/mixed-room.yaml", "a world, \"mixed-room\""},
        {"/fields/12x8.yaml", "a field, 12 × 8 m, with 18 lines"},
        {"/robots/b21.yaml", "a robot, \"b21\""},
        {"/campaigns/armingol-policies.yaml", "a campaign, \"armingol-policies\""},
        {"/fuzzy/choice.fll", "a fuzzy rule base, with 3 inputs"}}) {
    const auto result = vigia("check " + config + file);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr(said));
  }
}

TEST_F(Program, SaysAsWhatItCheckedAFile) {
  const auto campaign = file("campaign.yaml", "version: 1\nname: c\nmission: none.yaml\n");
  const auto result = vigia("check " + campaign.string());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("none.yaml"));
  EXPECT_THAT(result.err, HasSubstr("(checked as a campaign)"));
}

TEST_F(Program, ReportsAMissionThatDidNotArriveWithStatusOneAndAWholeRunFolder) {
  const auto result = vigia(short_run(dir_.path() / "run"));
  EXPECT_EQ(result.status, 1) << result.err;
  for (const char* name :
       {"summary.json", "mission.yaml", "truth.tum", "ekf.tum", "odometry.tum", "ticks.csv",
        "events.jsonl", "map.png", "timing.json", "timing.csv", "report.html"})
    EXPECT_TRUE(fs::exists(dir_.path() / "run" / name)) << name;
  const auto summary =
      nlohmann::json::parse(vigia::testing::read_text(dir_.path() / "run/summary.json"));
  EXPECT_EQ(summary["outcome"], "timeout");
}

TEST_F(Program, RefusesASeedThatNoMissionFileCouldHold) {
  for (const std::string seed : {"-1", "1.5", "9000000000000001", "99999999999999999999"}) {
    const auto result = vigia(short_run(dir_.path() / "run") + " --seed " + seed);
    EXPECT_EQ(result.status, 2) << seed;
    EXPECT_THAT(result.err, HasSubstr("--seed: found '" + seed + "', must be a whole number in"));
    EXPECT_FALSE(fs::exists(dir_.path() / "run"));
  }
}

TEST_F(Program, PrintsTheSummaryAndNothingElseOnStdoutWithJson) {
  const auto result = vigia(short_run(dir_.path() / "run") + " --json");
  EXPECT_EQ(nlohmann::json::parse(result.out)["mission"], "armingol-room");
}

TEST_F(Program, RepeatsARunFromItsResolvedMission) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "first") + " --seed 9").status, 1);
  const auto resolved = dir_.path() / "first/mission.yaml";
  const auto result =
      vigia("run " + resolved.string() + " --quiet --out " + (dir_.path() / "again").string());
  ASSERT_EQ(result.status, 1) << result.err;
  EXPECT_EQ(vigia::testing::read_text(dir_.path() / "first/ticks.csv"),
            vigia::testing::read_text(dir_.path() / "again/ticks.csv"));
}

TEST_F(Program, GivesTheSameBytesInTwoProcesses) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "a") + " --seed 7").status, 1);
  ASSERT_EQ(vigia(short_run(dir_.path() / "b") + " --seed 7").status, 1);
  for (const char* name :
       {"summary.json", "ticks.csv", "events.jsonl", "map.png", "truth.tum", "report.html"})
    EXPECT_EQ(vigia::testing::read_text(dir_.path() / "a" / name),
              vigia::testing::read_text(dir_.path() / "b" / name))
        << name;
}

TEST_F(Program, LeavesTheReplayPageOutWhereItIsNotWanted) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "run") + " --no-report").status, 1);
  EXPECT_FALSE(fs::exists(dir_.path() / "run/report.html"));
  EXPECT_TRUE(fs::exists(dir_.path() / "run/map.png"));
}

TEST_F(Program, LeavesAllPicturesOutWhereTheyAreNotWanted) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "with")).status, 1);
  const auto result = vigia(short_run(dir_.path() / "without") + " --no-pictures");
  ASSERT_EQ(result.status, 1);
  EXPECT_THAT(result.out, Not(HasSubstr("map.png")));
  for (const char* name : {"frames", "map.png", "report.html"})
    EXPECT_FALSE(fs::exists(dir_.path() / "without" / name)) << name;
  for (const char* name : {"summary.json", "ticks.csv", "events.jsonl"})
    EXPECT_EQ(vigia::testing::read_text(dir_.path() / "without" / name),
              vigia::testing::read_text(dir_.path() / "with" / name))
        << name;
}

// What these need takes half a second and 70 MB to load; a campaign's processes do without.
TEST_F(Program, StartsWithoutTheLibrariesOfPicturesVideosAndWindows) {
  const auto needed = vigia::testing::run_process(std::string("ldd ") + VIGIA_PROGRAM, dir_.path());
  ASSERT_EQ(needed.status, 0) << needed.err;
  EXPECT_THAT(needed.out, HasSubstr("libvisp_core"));
  for (const char* library : {"libvisp_robot", "libvisp_gui", "imgcodecs", "videoio", "libgdal"})
    EXPECT_THAT(needed.out, Not(HasSubstr(library)));
}

TEST_F(Program, ReplaysTwoRunFoldersOnOnePage) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "a") + " --seed 1").status, 1);
  ASSERT_EQ(vigia(short_run(dir_.path() / "b") + " --seed 2").status, 1);
  const auto page = dir_.path() / "both.html";
  const auto result = vigia("report " + (dir_.path() / "a").string() + " " +
                            (dir_.path() / "b").string() + " -o " + page.string());
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, page.string() + "\n");
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(vigia::testing::read_text(page), HasSubstr("2 drives of armingol-room"));
}

TEST_F(Program, SaysThatAFoldersDriveIsNotRepeated) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "run") + " --seed 1 --no-report").status, 1);
  file("run/summary.json", R"({"mission": "armingol-room", "version": "0.0.1"})");
  const auto result = vigia("report " + (dir_.path() / "run").string());
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("differs from the folder's"));
  EXPECT_THAT(vigia::testing::read_text(dir_.path() / "run/report.html"),
              HasSubstr("differs from the folder's"));
}

TEST_F(Program, ReplaysAFolderWhoseOtherFilesAreNone) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "run") + " --no-report").status, 1);
  for (const char* name : {"run/summary.json", "run/ticks.csv"})
    fs::resize_file(dir_.path() / name, 2'000'000'000);  // sparse
  fs::remove(dir_.path() / "run/events.jsonl");
  const auto result = vigia("report " + (dir_.path() / "run").string());
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("summary.json is too large to be one"));
  EXPECT_LT(fs::file_size(dir_.path() / "run/report.html"), 1'000'000U);
}

TEST_F(Program, RefusesToReplayAMissionThatIsNone) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "run") + " --no-report").status, 1);
  const fs::path mission = dir_.path() / "run/mission.yaml";
  const auto expect_refused = [&](const std::string& message) {
    const auto result = vigia("report " + (dir_.path() / "run").string());
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_FALSE(fs::exists(dir_.path() / "run/report.html"));
  };
  file("run/mission.yaml", "a_key_of_another_version: 3\n" + vigia::testing::read_text(mission));
  expect_refused("mission.yaml:1:1: unknown key 'a_key_of_another_version'");
  file("run/mission.yaml", "version: 1\nrobot: {radius_m");
  expect_refused("mission.yaml:2:");
  fs::resize_file(mission, 2'000'000'000);
  expect_refused("mission.yaml: the file is larger than 16 MB");
}

TEST_F(Program, SaysWhatIsMissingInAFolderThatIsNoRun) {
  const auto result = vigia("report " + dir_.path().string());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("is no run folder: there is no mission.yaml"));
}

TEST_F(Program, ReplacesAnEarlierRunFolder) {
  ASSERT_EQ(vigia(short_run(dir_.path() / "run") + " --seed 1").status, 1);
  ASSERT_EQ(vigia(short_run(dir_.path() / "run") + " --seed 2").status, 1);
  EXPECT_THAT(vigia::testing::read_text(dir_.path() / "run/summary.json"),
              HasSubstr("\"seed\": 2"));
}

TEST_F(Program, KeepsAFolderThatIsNoRunFolder) {
  fs::create_directory(dir_.path() / "mine");
  file("mine/thesis.tex", "years of work");
  const auto result = vigia(short_run(dir_.path() / "mine"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("is not one of ours"));
  EXPECT_EQ(vigia::testing::read_text(dir_.path() / "mine/thesis.tex"), "years of work");
}

TEST_F(Program, RejectsAnOutputPathBelowARegularFile) {
  const auto plain = file("plain", "text");
  const auto result = vigia(short_run(plain / "run"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("plain/run"));
  EXPECT_EQ(vigia::testing::read_text(plain), "text");
}

TEST_F(Program, LeavesNothingBehindOnAFullDisk) {
  const auto disk = dir_.path() / "disk";
  fs::create_directory(disk);
  // A mount of its own namespace: gone with the process.
  const std::string inside = "mount -t tmpfs -o size=96k none " + disk.string() + " || exit 77; " +
                             std::string(VIGIA_PROGRAM) + " " + short_run(disk / "run") +
                             "; status=$?; ls -A " + disk.string() + "; exit $status";
  const auto result =
      vigia::testing::run_process("unshare --mount sh -c '" + inside + "'", dir_.path());
  if (result.status == 77 || result.err.find("unshare") != std::string::npos)
    GTEST_SKIP() << "no right to mount a tmpfs here";
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr("No space left on device"));
  EXPECT_EQ(result.out, "");
}

TEST_F(Program, LeavesNothingBehindWhereFilesMayNotGrow) {
  const auto out = dir_.path() / "limited";
  fs::create_directory(out);
  const auto result =
      vigia::testing::run_process("sh -c 'ulimit -f 16; exec " + std::string(VIGIA_PROGRAM) + " " +
                                      short_run(out / "run") + "'",
                                  dir_.path());
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr("File too large"));
  EXPECT_TRUE(fs::is_empty(out));
}

TEST_F(Program, LeavesNothingBehindWhenItIsInterrupted) {
  const std::string out = (dir_.path() / "run").string();
  const std::string drive =
      std::string(VIGIA_PROGRAM) + " run " + kMission + " --quiet --out " + out;
  // Once the folder aside is there, the mission has begun.
  const auto script = file("script", drive + " & while ! ls -d " + dir_.path().string() +
                                         "/.run.part-* >/dev/null 2>&1; do sleep 0.01; done\n" +
                                         "kill -TERM $!; wait $!\n");
  const auto result = vigia::testing::run_process("sh " + script.string(), dir_.path());
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_THAT(result.err, HasSubstr("interrupted at t = "));
  EXPECT_THAT(vigia::testing::run_process("ls -A " + dir_.path().string(), dir_.path()).out,
              Not(HasSubstr("run")));
}

TEST_F(Program, RemovesWhatAKilledRunOfTheSameFolderLeft) {
  const auto ended = vigia::testing::run_process("sh -c 'echo $$'", dir_.path()).out;
  const std::string left = ".run.part-" + ended.substr(0, ended.find('\n'));
  const std::string living = ".run.part-" + std::to_string(::getpid());
  for (const std::string& name : {left, living}) fs::create_directory(dir_.path() / name);
  file(left + "/ticks.csv", "t_s");
  EXPECT_EQ(vigia(short_run(dir_.path() / "run")).status, 1);
  EXPECT_FALSE(fs::exists(dir_.path() / left));
  EXPECT_TRUE(fs::exists(dir_.path() / living));
}

TEST_F(Program, NamesTheKeyOfAWrongOverride) {
  const auto result = vigia("run " + kMission + " --set planner.polcy=nearest");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("polcy"));
  EXPECT_THAT(result.err, HasSubstr("policy"));
}

TEST_F(Program, ReportsAMissingMissionFile) {
  const auto result = vigia("run " + (dir_.path() / "none.yaml").string());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("none.yaml"));
}

TEST_F(Program, PrintsAPatternAndReadsItBack) {
  const auto print = dir_.path() / "pattern.png";
  const auto printed =
      vigia("landmark pattern --floor 7 --room 42 --pattern 5 --dpi 60 -o " + print.string());
  EXPECT_EQ(printed.status, 0) << printed.err;
  EXPECT_EQ(printed.out, "");
  const auto result = vigia("track --tracker pattern " + print.string());
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("found,7-42-5"));
}

TEST_F(Program, SaysWhichLandmarksThereAre) {
  const std::string out = " -o " + (dir_.path() / "x.pdf").string();
  for (const auto& [command, message] :
       {std::pair{"pattern --floor 12 --room 0 --pattern 0", "--floor 12: floors are 0–11"},
        {"pattern --floor 0 --room -1 --pattern 0", "--room -1: rooms are 0–80"},
        {"tag --id 587", "--id 587: tags of this family are 0–586"},
        {"tag --id 5 --side-m 0", "--side-m 0: must lie in [0.01, 1]"},
        {"disc --radius-m 3", "--radius-m 3: must lie in [0.005, 1]"},
        {"disc --dpi 1", "--dpi 1: must lie in [36, 2400]"}}) {
    const auto result = vigia(std::string("landmark ") + command + out);
    EXPECT_EQ(result.status, 2) << command;
    EXPECT_THAT(result.err, HasSubstr(message));
  }
  EXPECT_EQ(vigia("landmark tag --id 5 -o " + (dir_.path() / "x.doc").string()).status, 2);
  EXPECT_FALSE(fs::exists(dir_.path() / "x.pdf"));
}

struct WrongMission {
  const char* name;
  const char* override_;  ///< a `--set` that spoils the mission
  const char* message;    ///< part of what is said
};

void PrintTo(const WrongMission& mission, std::ostream* out) {
  *out << mission.name;
}

class WrongMissions : public Program, public ::testing::WithParamInterface<WrongMission> {};

TEST_P(WrongMissions, IsRejectedWithASentence) {
  const auto result = vigia("check " + kMission + " --set '" + GetParam().override_ + "'");
  EXPECT_EQ(result.status, 2) << result.out;
  EXPECT_THAT(result.err, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Overrides, WrongMissions,
    ::testing::Values(
        WrongMission{"UnknownPolicy", "planner.policy=oracel", "nearest"},
        WrongMission{"FixedWithoutLandmark", "planner.policy=fixed", "fixed_landmark"},
        WrongMission{"GazeThatSwings", "gaze.aim_gain=30", "it may be 25 at most"},
        WrongMission{
            "DoorTooNarrow",
            "world.walls=[{from_m: [3.4, 2.2], to_m: [3.4, 4.4]}, "
            "{from_m: [3.4, 4.2], to_m: [6.1, 4.2]}, {from_m: [6.5, 0], to_m: [6.5, 1.1]}, "
            "{from_m: [6.5, 1.68], to_m: [6.5, 7]}]",
            "too narrow for the robot"},
        WrongMission{"StartInTheWall", "start.position_m=[0.05, 1.0]", "does not fit"},
        WrongMission{"StartOutside", "start.position_m=[-3, 1]", "does not fit"},
        WrongMission{"GoalInTheWall", "route.goal_m=[11.99, 6.99]", "does not fit"},
        WrongMission{"GoalOutside", "route.goal_m=[40, 1]", "does not fit"},
        WrongMission{"NoPassage",
                     "world.obstacles=[{polygon_m: [[4.5, 0], [4.7, 0], [4.7, 4.1], [4.5, 4.1]], "
                     "height_m: 2}, {polygon_m: [[4.5, 4.3], [4.7, 4.3], [4.7, 7], [4.5, 7]], "
                     "height_m: 2}]",
                     "no route"},
        WrongMission{"NowhereToGo", "route={goal_m: [1.0, 3.4]}", "nothing to drive"},
        WrongMission{"NegativeRate", "rate_hz=-25", "-25"},
        WrongMission{"TextForNumber", "timeout_s=soon", "soon"},
        WrongMission{"NotANumber", "timeout_s=.nan", "timeout_s"},
        WrongMission{"UnknownTracker", "tracker=blob", "correlation"},
        WrongMission{"UnknownLocalizer", "localization.primary=gps", "ekf"},
        WrongMission{"LocalizerThatDoesNotFit", "localization.primary=pattern_fix",
                     "'pattern_fix' needs colour patterns in the world"},
        WrongMission{"UnknownLocalizerInTheList", "localization.localizers=[ekf, odometri]",
                     "did you mean 'odometry'"},
        WrongMission{"LocalizerTwice", "localization.localizers=[ekf, ekf]", "before"},
        WrongMission{"NoLocalizer", "localization.localizers=[]", "one or more of ekf, odometry"},
        WrongMission{"PrimaryNotInTheList", "localization={localizers: [odometry], primary: ekf}",
                     "must be one of odometry"},
        WrongMission{"RenamedKey", "planner.fuzzy.least_value=0.5",
                     "'planner.fuzzy.least_value' is now 'planner.fuzzy.min_value'"},
        WrongMission{"LimitsReversed", "planner.trigger={limit_1_m: 0.2, limit_2_m: 0.1}", "0.1"},
        WrongMission{"ListForMap", "planner=[1, 2]", "planner"},
        WrongMission{"MissingWorld", "world=nowhere.yaml", "nowhere.yaml"},
        WrongMission{"ZoomTableOfOne", "robot.zoom.table=[{zoom_mm: 8, focal_px: 600}]", "zoom"}),
    [](const auto& mission) { return mission.param.name; });

}  // namespace
}  // namespace vigia
