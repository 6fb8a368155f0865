#include "short_campaign.hpp"

#include <cstdint>
#include <cstdio>

#include <gmock/gmock.h>

namespace vigia {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using vigia::testing::read_text;

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// 64-bit FNV-1a as sixteen hexadecimal digits.
std::string fnv1a(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

/// The line with a checksum of its own, of all before its last member.
std::string sealed(const std::string& line) {
  const std::string open = line.substr(0, line.rfind(",\"check\":"));
  return open + ",\"check\":\"" + fnv1a(open) + "\"}";
}

class CampaignShards : public ShortCampaign {
 protected:
  void SetUp() override {
    write_campaign(4);
    ASSERT_EQ(plan(out_, 3).status, 0);
  }
  void run_all() const {
    for (const int k : {3, 1, 2}) ASSERT_EQ(run_shard(out_, k).status, 0);
  }
  vigia::testing::ProcessResult merge(const std::string& more = "") const {
    return vigia(step("merge", out_) + more);
  }
  /// Changes the first line of a file, and its checksum with it.
  static void change_header(const fs::path& file, const std::string& from, const std::string& to) {
    std::string text = read_text(file);
    std::string header = text.substr(0, text.find('\n'));
    const std::string rest = text.substr(header.size());
    header.replace(header.find(from), from.size(), to);
    write_text(file, sealed(header) + rest);
  }
};

TEST_F(CampaignShards, MergedGiveTheBytesOfOneProcessWhateverTheirOrder) {
  run_all();
  ASSERT_EQ(evaluate(whole_).status, 1);  // after one second nobody has arrived
  const auto merged = merge();
  EXPECT_EQ(merged.status, 1) << merged.err;
  expect_same_results(out_, whole_);
}

TEST_F(CampaignShards, AreTheSameBytesWhoeverDrivesThem) {
  run_all();
  const std::string text = read_text(shard(out_, 2));
  fs::remove(shard(out_, 2));
  ASSERT_EQ(vigia(step("run-shard", out_) + "2 -j 2 --quiet").status, 0);
  EXPECT_EQ(read_text(shard(out_, 2)), text);
}

TEST_F(CampaignShards, DrivenByThreeProcessesAtOnceComeToNoHarm) {
  run_all();
  const std::string text = read_text(shard(out_, 2));
  fs::remove(shard(out_, 2));
  std::vector<pid_t> processes(3);
  for (pid_t& process : processes) process = start(step("run-shard", out_) + "2 -j 1");
  for (const pid_t process : processes) EXPECT_EQ(wait_for(process), 0);
  EXPECT_EQ(read_text(shard(out_, 2)), text);
  for (const auto& entry : fs::directory_iterator(out_ / "shards"))
    EXPECT_THAT(entry.path().string(), Not(HasSubstr(".part-")));
}

TEST_F(CampaignShards, ThatAreWholeAreNotDrivenAgain) {
  run_all();
  const auto written = fs::last_write_time(shard(out_, 1));
  EXPECT_EQ(run_shard(out_, 1).status, 0);
  EXPECT_EQ(fs::last_write_time(shard(out_, 1)), written);
}

TEST_F(CampaignShards, ThatAreMissingAreNamed) {
  ASSERT_EQ(run_shard(out_, 2).status, 0);
  const auto merged = merge();
  EXPECT_EQ(merged.status, 2);
  EXPECT_THAT(merged.err, HasSubstr("missing of 3 shards: 1, 3"));
  EXPECT_THAT(merge("--dry-run").out, HasSubstr("shard 3: missing"));
  EXPECT_EQ(status(out_)["shards"][1]["status"], "whole");
  EXPECT_EQ(status(out_)["shards"][2]["status"], "missing");
}

TEST_F(CampaignShards, ThatAreCutOffAreNamedRefusedAndDrivenAgain) {
  run_all();
  const std::string text = read_text(shard(out_, 1));
  for (const std::size_t size : {text.size() - 1, text.size() - 200, text.size() / 2}) {
    write_text(shard(out_, 1), text.substr(0, size));
    const auto merged = merge();
    EXPECT_EQ(merged.status, 2) << size;
    EXPECT_THAT(merged.err, HasSubstr("shards/00001.jsonl: it is cut off")) << size;
  }
  write_text(shard(out_, 1), "");
  EXPECT_THAT(merge().err, HasSubstr("shards/00001.jsonl: its first line is damaged"));
  EXPECT_THAT(run_shard(out_, 1).err, HasSubstr("is driven again"));
  EXPECT_EQ(read_text(shard(out_, 1)), text);
}

TEST_F(CampaignShards, OfOtherBytesAreRefusedWithTheLine) {
  run_all();
  std::string text = read_text(shard(out_, 1));
  const std::size_t digit = text.find("\"sim_s\":") + 8;
  text[digit] = text[digit] == '1' ? '2' : '1';
  write_text(shard(out_, 1), text);
  const auto merged = merge();
  EXPECT_EQ(merged.status, 2);
  EXPECT_THAT(merged.err, HasSubstr("shards/00001.jsonl:2:1: this line is damaged"));
}

TEST_F(CampaignShards, OfAnotherCampaignAreNamedRefusedAndDrivenAgain) {
  run_all();
  const fs::path other = dir_.path() / "other";
  ASSERT_EQ(plan(other, 3, "--set planner.dwell_s=2").status, 0);
  ASSERT_EQ(run_shard(other, 1).status, 0);
  const std::string text = read_text(shard(out_, 1));
  fs::copy_file(shard(other, 1), shard(out_, 1), fs::copy_options::overwrite_existing);
  const auto merged = merge();
  EXPECT_EQ(merged.status, 2);
  EXPECT_THAT(merged.err, HasSubstr("shards/00001.jsonl: its configuration is "));
  EXPECT_THAT(vigia(step("run-shard", out_) + "1 --dry-run").out, HasSubstr("stale"));
  EXPECT_THAT(run_shard(out_, 1).err, HasSubstr("is driven again: its configuration is "));
  EXPECT_EQ(read_text(shard(out_, 1)), text);
}

TEST_F(CampaignShards, UnderAnotherNumberAreRefused) {
  run_all();
  fs::copy_file(shard(out_, 1), shard(out_, 2), fs::copy_options::overwrite_existing);
  EXPECT_THAT(merge().err, HasSubstr("it is shard 1 of 3, the plan's is 2 of 3"));
}

TEST_F(CampaignShards, OfAnotherVersionAreMixedOnlyWhenAsked) {
  run_all();
  // A shard of the same bytes but for the version, sealed anew from its first line to its last.
  std::string text = read_text(shard(out_, 3));
  const std::size_t header = text.find('\n');
  std::string first = text.substr(0, header);
  first.replace(first.find("\"0."), 3, "\"9.");
  const std::size_t end = text.rfind('\n', text.size() - 2) + 1;
  const std::string body = sealed(first) + text.substr(header, end - header);
  const std::string last = "{\"missions\":3,\"bytes\":" + std::to_string(body.size()) +
                           ",\"checksum\":\"" + fnv1a(body) + "\",\"check\":";
  write_text(shard(out_, 3), body + sealed(last) + "\n");
  const auto merged = merge();
  EXPECT_EQ(merged.status, 2);
  EXPECT_THAT(merged.err, HasSubstr("shards/00003.jsonl: its version is 9."));
  EXPECT_EQ(merge("--any-version").status, 1);
  EXPECT_THAT(read_text(out_ / "summary.json"), HasSubstr("\"mixed_programs\""));
}

TEST_F(CampaignShards, OfAPlanOfAnotherFormAreRefused) {
  change_header(out_ / "plan.json", "\"shards\":3", "\"pieces\":3");
  const auto driven = run_shard(out_, 1);
  EXPECT_EQ(driven.status, 2);
  EXPECT_THAT(driven.err, HasSubstr("plan.json is not of the form"));
}

TEST_F(CampaignShards, OfAnotherBuildsPlanAreRefused) {
  change_header(out_ / "plan.json", "\"build\":\"", "\"build\":\"0");
  const auto driven = run_shard(out_, 1);
  EXPECT_EQ(driven.status, 2);
  EXPECT_THAT(driven.err, HasSubstr("--any-version mixes them"));
  for (const int k : {1, 2, 3}) EXPECT_EQ(run_shard(out_, k, "--any-version").status, 0);
  EXPECT_EQ(merge().status, 2);
  EXPECT_EQ(merge("--any-version").status, 1);
}

TEST_F(CampaignShards, OfAFullDiskAreRefusedAndResumed) {
  // Signal 25 is SIGXFSZ: ignored, a write past the limit fails instead of ending the process.
  const std::string limited = "trap '' 25; ulimit -f 8; exec " + std::string(VIGIA_PROGRAM) + " " +
                              step("run-shard", out_) + "1 -j 1 --quiet";
  const auto full = vigia::testing::run_process("sh -c \"" + limited + "\"", dir_.path());
  EXPECT_EQ(full.status, 2);
  EXPECT_THAT(full.err, HasSubstr("cannot write " + shard(out_, 1).string()));
  EXPECT_THAT(full.err, HasSubstr("File too large"));
  EXPECT_EQ(status(out_)["shards"][0]["status"], "begun");
  run_all();
  ASSERT_EQ(evaluate(whole_).status, 1);
  EXPECT_EQ(merge().status, 1);
  expect_same_results(out_, whole_);
}

TEST_F(CampaignShards, AreNeitherPlannedNorMergedOnAFullDisk) {
  run_all();
  const auto limited = [&](const std::string& blocks, const std::string& arguments) {
    return vigia::testing::run_process("sh -c \"trap '' 25; ulimit -f " + blocks + "; exec " +
                                           std::string(VIGIA_PROGRAM) + " " + arguments + "\"",
                                       dir_.path());
  };
  const auto merged = limited("4", step("merge", out_));
  EXPECT_EQ(merged.status, 2);
  EXPECT_THAT(merged.err, HasSubstr("File too large"));
  const auto planned =
      limited("8", "campaign plan " + file_.string() + " --shards 3 --out " + whole_.string());
  EXPECT_EQ(planned.status, 2);
  EXPECT_THAT(planned.err, HasSubstr("File too large"));
  EXPECT_FALSE(fs::exists(whole_ / "plan.json"));
}

TEST_F(CampaignShards, HaveTheCommandThatRepeatsTheWorstMission) {
  run_all();
  ASSERT_EQ(merge().status, 1);
  const auto worst = nlohmann::json::parse(read_text(out_ / "summary.json"))["worst"][0];
  std::string command = worst["command"];
  ASSERT_THAT(command, StartsWith("vigia "));
  command = "cd " + out_.string() + " && " + VIGIA_PROGRAM + command.substr(5);
  const auto again = vigia::testing::run_process(
      command + " --json --quiet --out " + (dir_.path() / "again").string(), dir_.path());
  const auto summary = nlohmann::json::parse(again.out);
  EXPECT_EQ(summary["localizers"]["ekf"]["position_max_m"], worst["position_max_m"]);
}

TEST_F(CampaignShards, PlannedAgainAreTheSamePlan) {
  const std::string text = read_text(out_ / "plan.json");
  EXPECT_EQ(plan(out_, 3).status, 0);
  EXPECT_EQ(read_text(out_ / "plan.json"), text);
}

TEST_F(CampaignShards, OfAnotherPlanAreStaleOnceItIsReplaced) {
  run_all();
  const auto refused = plan(out_, 3, "--set planner.dwell_s=2");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("holds another plan"));
  EXPECT_THAT(plan(out_, 4).err, HasSubstr("a plan of 3 shards, now there are 4"));
  EXPECT_THAT(plan(out_, 3, "--set planner.dwell_s=2 --dry-run").out,
              HasSubstr("shard 1: stale, its configuration is "));
  ASSERT_EQ(plan(out_, 3, "--set planner.dwell_s=2 --restart").status, 0);
  EXPECT_EQ(status(out_)["shards"][0]["status"], "stale");
}

TEST_F(CampaignShards, NeedAFolderOfOursAndAPlan) {
  const fs::path thesis = dir_.path() / "thesis";
  fs::create_directories(thesis);
  write_text(thesis / "thesis.tex", "years of work");
  EXPECT_THAT(plan(thesis, 2).err, HasSubstr("is not one of ours"));
  EXPECT_THAT(run_shard(thesis, 1).err, HasSubstr("has no plan.json"));
  EXPECT_THAT(evaluate(out_).err, HasSubstr("is not one of ours"));
  write_text(out_ / "plan.json", read_text(out_ / "plan.json").substr(0, 300));
  EXPECT_THAT(run_shard(out_, 1).err, HasSubstr("plan.json is damaged"));
}

TEST_F(CampaignShards, AreCountedFromOneToAsManyAsMissions) {
  EXPECT_THAT(plan(dir_.path() / "many", 9).err, HasSubstr("must be 1 … 8"));
  const auto fourth = run_shard(out_, 4);
  EXPECT_EQ(fourth.status, 2);
  EXPECT_THAT(fourth.err, HasSubstr("found shard 4, must be 1 … 3"));
  EXPECT_EQ(run_shard(out_, 0).status, 2);
}

TEST_F(CampaignShards, OfAChangedMissionAreRefused) {
  write_text(out_ / "missions/001.yaml", "version: 1\n");
  EXPECT_THAT(run_shard(out_, 1).err, HasSubstr("missions/001.yaml is missing or not the mission"));
}

}  // namespace
}  // namespace vigia
