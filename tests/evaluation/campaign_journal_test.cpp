#include "vigia/evaluation/campaign_journal.hpp"

#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/evaluation/campaign_run.hpp"

namespace vigia::evaluation {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using vigia::testing::read_text;

/// Two arms, three seeds of a mission that ends after a second.
const Campaign& small_campaign() {
  static const Campaign campaign = [] {
    const vigia::testing::TempDir dir;
    std::ofstream(dir.path() / "small.yaml")
        << "version: 1\nname: small\nmission: " << VIGIA_SOURCE_DIR
        << "/config/missions/armingol-room.yaml\nset: [timeout_s=1, planner.trigger.distance_m=0]\n"
        << "policies: [nearest, random]\nseeds: {count: 3}\n";
    return read_campaign(dir.path() / "small.yaml");
  }();
  return campaign;
}

class Journal : public ::testing::Test {
 protected:
  std::string mistake(const Campaign& campaign, bool restart = false) const {
    try {
      const CampaignJournal journal(folder_, campaign, restart);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  /// Runs the campaign as far as it is left and gives all scores as text.
  std::vector<std::string> run(int threads = 1) const {
    CampaignJournal journal(folder_, small_campaign(), false);
    run_campaign(small_campaign(), journal, threads);
    std::vector<std::string> records;
    for (const auto& arm : scores_by_arm(small_campaign(), journal.finished()))
      for (const auto& score : arm) records.push_back(score_record(score));
    return records;
  }
  std::string journal() const { return read_text(folder_ / "journal.jsonl"); }
  void write_journal(const std::string& text) const {
    std::ofstream(folder_ / "journal.jsonl", std::ios::binary) << text;
  }
  static int lines(const std::string& text) {
    return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  }
  vigia::testing::TempDir dir_;
  fs::path folder_ = dir_.path() / "out";
};

TEST_F(Journal, GivesEveryMissionOnceWhateverTheThreads) {
  const auto records = run(1);
  EXPECT_EQ(records.size(), 6u);
  EXPECT_EQ(lines(journal()), 6);
  fs::remove_all(folder_);
  EXPECT_EQ(run(2), records);
}

TEST_F(Journal, ARepeatedRunAddsNothing) {
  const auto records = run();
  const std::string before = journal();
  EXPECT_EQ(run(), records);
  EXPECT_EQ(journal(), before);
}

TEST_F(Journal, CutAnywhereItEndsTheSame) {
  const auto records = run();
  const std::string whole = journal();
  // At the ends of lines, just beside them, and in the middle of one.
  const std::size_t second = whole.find('\n', whole.find('\n') + 1);
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, second - 1, second, second + 1, whole.size() - 1}) {
    write_journal(whole.substr(0, size));
    EXPECT_EQ(run(), records) << size;
    EXPECT_EQ(lines(journal()), 6) << size;
  }
}

TEST_F(Journal, ALastLineWithAWrongChecksumIsRunAgain) {
  const auto records = run();
  std::string text = journal();
  text[text.size() - 40] = text[text.size() - 40] == '1' ? '2' : '1';
  write_journal(text);
  EXPECT_EQ(run(), records);
  EXPECT_EQ(lines(journal()), 6);
}

TEST_F(Journal, ADamagedLineThatIsNotTheLastIsRefused) {
  run();
  std::string text = journal();
  text[20] = text[20] == '1' ? '2' : '1';
  write_journal(text);
  EXPECT_THAT(mistake(small_campaign()), HasSubstr("journal.jsonl:1:1"));
}

TEST_F(Journal, OfAnotherMissionIsRefusedAndSaysWhatDiffers) {
  run();
  Campaign other = small_campaign();
  auto& yaml = other.arms[1].setup.resolved_yaml;
  yaml.replace(yaml.find("timeout_s: 1"), 12, "timeout_s: 2");
  const std::string message = mistake(other);
  EXPECT_THAT(message, HasSubstr("arm \"random\""));
  EXPECT_THAT(message, HasSubstr("\"timeout_s: 1\" there, \"timeout_s: 2\" now"));
  EXPECT_THAT(message, HasSubstr("--restart"));
}

TEST_F(Journal, OfAnotherCampaignOrVersionIsRefused) {
  run();
  Campaign other = small_campaign();
  other.name = "other";
  EXPECT_THAT(mistake(other), HasSubstr("its campaign is small, now it is other"));
  other = small_campaign();
  other.arms.pop_back();
  EXPECT_THAT(mistake(other), HasSubstr("it has 2 arms, now there are 1"));
  std::string header = read_text(folder_ / "campaign.json");
  const std::size_t version = header.find("\"version\": \"") + 12;
  header.insert(version, "9.");
  std::ofstream(folder_ / "campaign.json") << header;
  EXPECT_THAT(mistake(small_campaign()), HasSubstr("its version is 9."));
}

TEST_F(Journal, OfAnotherBuildIsRefused) {
  run();
  std::string header = read_text(folder_ / "campaign.json");
  const std::size_t build = header.find("\"build\": \"") + 10;
  header[build] = header[build] == '0' ? '1' : '0';
  std::ofstream(folder_ / "campaign.json") << header;
  EXPECT_THAT(mistake(small_campaign()), HasSubstr("its build is "));
}

TEST_F(Journal, BegunAnewForgetsTheOtherCampaign) {
  run();
  Campaign other = small_campaign();
  other.name = "other";
  EXPECT_EQ(mistake(other, true), "");
  EXPECT_EQ(journal(), "");
}

TEST_F(Journal, WithMoreSeedsKeepsWhatItHas) {
  run();
  Campaign more = small_campaign();
  more.seeds = 4;
  CampaignJournal journal(folder_, more, false);
  CampaignProgress first;
  run_campaign(more, journal, 1, [&](const CampaignProgress& p) {
    if (first.total == 0) first = p;
  });
  EXPECT_EQ(first.before, 6u);
  EXPECT_EQ(first.total, 8u);
}

TEST_F(Journal, KeepsAFolderThatIsNotOurs) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "thesis.tex") << "years of work";
  EXPECT_THAT(mistake(small_campaign()), HasSubstr("is not one of ours"));
  EXPECT_THAT(mistake(small_campaign(), true), HasSubstr("is not one of ours"));
  EXPECT_EQ(read_text(folder_ / "thesis.tex"), "years of work");
}

TEST_F(Journal, ABeginningThatWasKilledAtOnceIsOurs) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "campaign.json.part") << "{";
  EXPECT_EQ(mistake(small_campaign()), "");
}

TEST_F(Journal, IsOneProcessesAtATime) {
  const CampaignJournal first(folder_, small_campaign(), false);
  EXPECT_THAT(mistake(small_campaign()), HasSubstr("another process is at work"));
}

TEST(ScoreRecord, ComesBackEqualToTheBit) {
  DriveScore score;
  score.mission = "m \"quoted\"";
  score.seed = 1234567890123456789ULL;
  score.outcome = mission::Outcome::stuck;
  score.sim_s = 0.1 + 0.2;
  score.primary = "ekf";
  LocalizerScore& ekf = score.localizers["ekf"];
  ekf.position_rmse_m = 1.0 / 3.0;
  ekf.nees_mean = 5e-324;
  ekf.lost = {{1.5, std::nullopt, std::nullopt}, {std::nullopt, 2.25, 3.0}};
  ekf.loss.false_alarms = 2;
  ekf.loss.delay_mean_s = 1.0 / 7.0;
  ekf.loss.brier = 0.1 + 0.7;
  ekf.loss.calibration[7] = {5, 0.1 + 0.6, 3};
  ekf.looks = {{3, 0.1, 0.2, 0.3}, {4, 1e300, -0.0, 0.7}};
  ekf.in_space = SpaceScore{{3, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}, {2, 1.0 / 9.0}};
  score.perception.looks = 22;
  score.recovery = {2, 1, 0.7};
  const std::string record = score_record(score);
  const DriveScore back = score_from_record(record);
  EXPECT_EQ(score_record(back), record);
  EXPECT_EQ(back.seed, score.seed);
  EXPECT_EQ(back.outcome, score.outcome);
  EXPECT_EQ(back.sim_s, score.sim_s);
  EXPECT_EQ(back.localizers.at("ekf").position_rmse_m, 1.0 / 3.0);
  EXPECT_EQ(back.localizers.at("ekf").looks[1].nees, 1e300);
  EXPECT_EQ(back.localizers.at("ekf").lost[1].passed_s, 2.25);
  EXPECT_FALSE(back.localizers.at("ekf").lost[0].ended_s);
  EXPECT_EQ(back.localizers.at("ekf").loss.calibration[7].mean_probability, 0.1 + 0.6);
  EXPECT_EQ(back.localizers.at("ekf").in_space->ramps.z_rms_m, 1.0 / 9.0);
  EXPECT_EQ(back.localizers.at("ekf").in_space->level.nees_mean, 0.7);
  EXPECT_EQ(back.recovery.recovering_s, 0.7);
}

TEST(ScoreRecord, WithoutItsLossesIsRefused) {
  DriveScore score;
  score.localizers["ekf"].lost = {{1.5, 2.0, 3.0}};
  std::string record = score_record(score);
  ASSERT_NO_THROW(score_from_record(record));
  record.replace(record.find("\"lost\":[{"), 6, "\"gone\"");
  EXPECT_THROW(score_from_record(record), std::exception);
}

}  // namespace
}  // namespace vigia::evaluation
