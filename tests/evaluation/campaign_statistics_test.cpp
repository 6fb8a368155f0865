#include "vigia/evaluation/campaign_statistics.hpp"

#include "lost_episodes.hpp"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "vigia/evaluation/campaign_report.hpp"

namespace vigia::evaluation {
namespace {

using ::testing::HasSubstr;

DriveScore drive(std::uint64_t seed, double rms, int looks) {
  DriveScore score;
  score.seed = seed;
  score.outcome = mission::Outcome::arrived;
  score.primary = "ekf";
  score.perception.looks = looks;
  LocalizerScore& ekf = score.localizers["ekf"];
  ekf.position_rmse_m = rms;
  ekf.pcrlb_position_rms_m = 0.01;
  ekf.looks = {{1, 3.0, 1e-4, 1e-4}};
  return score;
}

Campaign two_arms() {
  Campaign campaign;
  campaign.name = "two";
  campaign.seeds = 3;
  campaign.arms.resize(2);
  campaign.arms[0].name = "a";
  campaign.arms[1].name = "b";
  for (auto& arm : campaign.arms) arm.setup.primary = "ekf";
  campaign.baseline = 1;
  return campaign;
}

std::vector<std::vector<DriveScore>> two_arms_scores() {
  return {{drive(1, 0.03, 11), drive(2, 0.05, 12), drive(3, 0.07, 13)},
          {drive(1, 0.02, 10), drive(2, 0.03, 10), drive(3, 0.04, 10)}};
}

TEST(CampaignStatistics, DifferencesArePairedBySeed) {
  const auto statistics = campaign_statistics(two_arms(), two_arms_scores());
  EXPECT_TRUE(statistics[1].differences.empty());
  ASSERT_EQ(campaign_metrics().front().key, "position_rmse_m");
  const Estimate& d = statistics[0].differences.front();
  // 1, 2, 3 cm: mean 2, standard error 1/√3, t(2 dof, 97.5 %) = 4.3027.
  EXPECT_NEAR(d.value, 0.02, 1e-12);
  EXPECT_NEAR(d.interval.high - d.value, 0.01 * 4.3027 / std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(statistics[0].means.front().value, 0.05, 1e-12);
}

TEST(CampaignStatistics, AFalseAlarmIsNoLossThatWasSaidInTime) {
  auto scores = two_arms_scores();
  scores[0][0].localizers["ekf"].lost = {{1.0, std::nullopt, 5.0, true},
                                         {6.0, std::nullopt, 7.0, true}};
  scores[0][2].localizers["ekf"].lost = {{4.0, 3.0, std::nullopt}, {5.0, 6.0, 9.0, true}};
  const auto losses = campaign_statistics(two_arms(), scores)[0].over_seeds.losses;
  EXPECT_EQ(losses.false_alarms, 2);
  EXPECT_EQ(losses.losses, 2);
  EXPECT_EQ(losses.announced, 1);
  EXPECT_EQ(losses.beyond, 2);
  EXPECT_EQ(losses.drives_without, 2);
  EXPECT_NEAR(losses.announced_share.high, clopper_pearson(1, 2).high, 1e-12);
}

TEST(CampaignStatistics, CountsWhatWasAnnouncedAndWhatEnded) {
  auto scores = two_arms_scores();
  scores[0][0].localizers["ekf"].lost = {{1.0, 2.0, 5.0}, {8.0, std::nullopt, 9.0}};
  scores[0][2].localizers["ekf"].lost = {{4.0, 3.0, std::nullopt}};
  const auto losses = campaign_statistics(two_arms(), scores)[0].over_seeds.losses;
  EXPECT_EQ(losses.episodes, 3);
  EXPECT_EQ(losses.announced, 2);
  EXPECT_EQ(losses.ended, 2);
  EXPECT_NEAR(losses.mean_lost_s, 0.5 * (4.0 + 1.0), 1e-12);
  EXPECT_NEAR(losses.announced_share.low, clopper_pearson(2, 3).low, 1e-12);
}

/// What stands in the row of @p arm below the heading @p label.
std::string markdown_cell(const std::string& text, const std::string& arm,
                          const std::string& label) {
  const auto cells = [&](std::size_t at) {
    std::vector<std::string> result;
    std::istringstream line(text.substr(at, text.find('\n', at) - at));
    for (std::string cell; std::getline(line, cell, '|');) result.push_back(cell);
    return result;
  };
  const auto labels = cells(text.find("| arm |"));
  const auto row = cells(text.find("\n| " + arm + " |") + 1);
  const auto it = std::find(labels.begin(), labels.end(), " " + label + " ");
  return it == labels.end() ? "no such label"
                            : row.at(static_cast<std::size_t>(it - labels.begin()));
}

TEST(CampaignReport, SaysWhatShareOfTheLossesWasSaidInTimeAndEnded) {
  auto scores = two_arms_scores();
  // Ten losses, nine said in time, seven ended.
  auto& lost = scores[0][1].localizers["ekf"].lost;
  for (int i = 0; i < 7; ++i) lost.push_back({1.0 + i, std::nullopt, 1.5 + i});
  scores[0][2].localizers["ekf"].lost = {{1.0, 2.0, std::nullopt}, {3.0, 3.0, std::nullopt}};
  scores[0][0].localizers["ekf"].lost = {{std::nullopt, 2.0, std::nullopt}};
  const auto campaign = two_arms();
  const auto statistics = campaign_statistics(campaign, scores);
  const std::string table = campaign_markdown(campaign, statistics);
  EXPECT_EQ(markdown_cell(table, "a", "times lost"), " 10 ");
  // The exact 95 % intervals of 9 and 7 in 10, from the tables of the beta distribution.
  EXPECT_EQ(markdown_cell(table, "a", "said before 50 cm"), " 9/10 [55.5, 99.7] % ");
  EXPECT_EQ(markdown_cell(table, "a", "found again"), " 7/10 [34.8, 93.3] % ");
  EXPECT_EQ(markdown_cell(table, "b", "times lost"), " 0 ");
  EXPECT_EQ(markdown_cell(table, "b", "said before 50 cm"), " – ");
  const auto json = nlohmann::json::parse(campaign_json(campaign, statistics, {}));
  EXPECT_EQ(json["arms"][0]["lost"]["announced"]["count"], 9);
  EXPECT_EQ(json["arms"][0]["lost"]["recovered"]["count"], 7);
  EXPECT_EQ(json["arms"][0]["lost"]["recovered"]["of"], 10);
  EXPECT_NEAR(json["arms"][0]["lost"]["recovered"]["low"].get<double>(), 0.348, 5e-4);
}

TEST(CampaignReport, OfOneArmSaysTheSame) {
  Campaign campaign = two_arms();
  campaign.arms.resize(1);
  campaign.baseline = 0;
  std::vector<std::vector<DriveScore>> scores{two_arms_scores()[0]};
  scores[0][0].localizers["ekf"].lost = {{1.0, 2.0, 5.0}};
  EXPECT_THAT(
      campaign_text(campaign, campaign_statistics(campaign, scores)),
      HasSubstr("times lost 1 (1 beyond 50 cm), said before 50 cm 1/1 [2.5, 100.0] %, found again "
                "1/1"));
}

TEST(CampaignReport, HasOneRowAnArmSeedAndLocalizer) {
  const std::string csv = campaign_csv(two_arms(), two_arms_scores());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 6);
  EXPECT_THAT(csv, HasSubstr("\n2,arrived,0.000,12,0,ekf,"));
  const auto columns = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  const std::size_t first = csv.find('\n');
  const std::size_t second = csv.find('\n', first + 1);
  EXPECT_EQ(columns(csv.substr(0, first)), columns(csv.substr(first, second - first)));
}

TEST(CampaignReport, NamesTheBaselineAndLeavesItWithoutDifferences) {
  const auto campaign = two_arms();
  const auto statistics = campaign_statistics(campaign, two_arms_scores());
  const auto json = nlohmann::json::parse(campaign_json(campaign, statistics, {}));
  EXPECT_EQ(json["baseline"], "b");
  EXPECT_NEAR(json["arms"][0]["differences"]["looks"]["value"].get<double>(), 2.0, 1e-12);
  EXPECT_TRUE(json["arms"][1]["differences"].empty());
  EXPECT_THAT(campaign_text(campaign, statistics), HasSubstr("differences from b"));
  EXPECT_THAT(campaign_markdown(campaign, statistics), HasSubstr("| a | 3/3 [29.2, 100.0] % |"));
}

TEST(WorstMissions, AreThoseThatDidNotArriveThenThoseWithTheLargestErrors) {
  auto scores = two_arms_scores();
  for (auto& arm : scores)
    for (auto& score : arm) score.localizers["ekf"].position_max_m = 0.1;
  scores[0][1].localizers["ekf"].position_max_m = 0.9;
  scores[1][2].outcome = mission::Outcome::stuck;
  const auto worst = worst_missions(scores, 2);
  ASSERT_EQ(worst.size(), 2u);
  EXPECT_EQ(
      repeat_command(worst[0].task, "my campaign"),
      "vigia run 'my campaign/missions/001.yaml' --seed " + std::to_string(scores[1][2].seed));
  EXPECT_EQ(repeat_command(worst[1].task, "."),
            "vigia run missions/000.yaml --seed " + std::to_string(scores[0][1].seed));
}

TEST(LossWatch, OpensWhenItSaysSoAndClosesWhenItTracksWithASmallError) {
  std::vector<LostEpisode> episodes;
  update_episodes(episodes, 1.0, false, 0.4, 0.05);
  EXPECT_TRUE(episodes.empty());
  update_episodes(episodes, 2.0, true, 0.4, 0.05);
  update_episodes(episodes, 3.0, true, 0.6, 0.05);
  update_episodes(episodes, 4.0, false, 0.3, 0.05);
  update_episodes(episodes, 5.0, false, 0.2, 0.05);
  update_episodes(episodes, 6.0, false, 0.4, 0.05);
  ASSERT_EQ(episodes.size(), 1u);
  EXPECT_EQ(episodes[0].said_s, 2.0);
  EXPECT_EQ(episodes[0].passed_s, 3.0);
  EXPECT_EQ(episodes[0].ended_s, 5.0);
  EXPECT_TRUE(episodes[0].announced());
  EXPECT_EQ(episodes[0].began_s(), 2.0);
}

TEST(LossWatch, AnErrorThatPassesUnsaidIsNotAnnounced) {
  std::vector<LostEpisode> episodes;
  update_episodes(episodes, 1.0, false, 0.51, 0.05);
  update_episodes(episodes, 2.0, true, 0.7, 0.05);
  ASSERT_EQ(episodes.size(), 1u);
  EXPECT_FALSE(episodes[0].announced());
  EXPECT_EQ(episodes[0].began_s(), 1.0);
  EXPECT_FALSE(episodes[0].ended_s);
}

TEST(LossWatch, SayingSoWithoutAReasonIsAFalseAlarmUnlessTheErrorPassesLater) {
  std::vector<LostEpisode> episodes;
  update_episodes(episodes, 1.0, true, 0.1, 0.05);
  EXPECT_TRUE(episodes.at(0).false_alarm());
  EXPECT_FALSE(episodes.at(0).announced());
  update_episodes(episodes, 2.0, true, 0.51, 0.05);
  EXPECT_FALSE(episodes.at(0).false_alarm());
  EXPECT_TRUE(episodes.at(0).announced());
}

TEST(LossWatch, AnErrorThatTheClaimedSigmaAllowsForIsNoLoss) {
  std::vector<LostEpisode> episodes;
  update_episodes(episodes, 1.0, false, 0.8, 0.3);
  EXPECT_TRUE(episodes.empty());
  update_episodes(episodes, 2.0, false, 1.3, 0.3);
  EXPECT_EQ(episodes.size(), 1u);
}

TEST(LossWatch, SayingSoBeyondFourSigmasIsNoFalseAlarm) {
  std::vector<LostEpisode> episodes;
  update_episodes(episodes, 1.0, true, 0.3, 0.05);
  EXPECT_FALSE(episodes.at(0).false_alarm());
  EXPECT_TRUE(episodes.at(0).announced());
}

TEST(LossWatch, SayingSoAtTheInstantItPassesCounts) {
  std::vector<LostEpisode> episodes;
  update_episodes(episodes, 1.0, true, 0.51, 0.05);
  EXPECT_TRUE(episodes.at(0).announced());
}

}  // namespace
}  // namespace vigia::evaluation
