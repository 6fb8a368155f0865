#include "vigia/evaluation/campaign_statistics.hpp"

#include "vigia/core/angle.hpp"

namespace vigia::evaluation {
namespace {

const LocalizerScore& primary(const DriveScore& score) {
  return score.localizers.at(score.primary);
}

std::vector<double> values(const std::vector<DriveScore>& scores, const CampaignMetric& metric) {
  std::vector<double> result;
  result.reserve(scores.size());
  for (const auto& score : scores) result.push_back(metric.value(score));
  return result;
}

}  // namespace

const std::vector<CampaignMetric>& campaign_metrics() {
  using Score = DriveScore;
  static const std::vector<CampaignMetric> metrics{
      {"position_rmse_m", "path RMS cm", 100.0, 2,
       [](const Score& s) { return primary(s).position_rmse_m; }},
      {"position_max_m", "path max cm", 100.0, 1,
       [](const Score& s) { return primary(s).position_max_m; }},
      {"position_final_m", "final cm", 100.0, 2,
       [](const Score& s) { return primary(s).position_final_m; }},
      {"heading_final_rad", "final °", to_deg(1.0), 3,
       [](const Score& s) { return primary(s).heading_final_rad; }},
      {"looks", "looks", 1.0, 1,
       [](const Score& s) { return static_cast<double>(s.perception.looks); }},
      {"stops", "stops", 1.0, 2,
       [](const Score& s) { return static_cast<double>(s.perception.stops); }},
      {"stopped_s", "stopped s", 1.0, 2, [](const Score& s) { return s.perception.stopped_s; }},
      {"lost_s", "lost s", 1.0, 2, [](const Score& s) { return primary(s).lost_s; }},
      {"sim_s", "drive s", 1.0, 1, [](const Score& s) { return s.sim_s; }},
      {"pan_travel_rad", "pan turns", 1.0 / (2.0 * kPi), 1,
       [](const Score& s) { return s.perception.pan_travel_rad; }},
  };
  return metrics;
}

std::vector<ArmStatistics> campaign_statistics(const Campaign& campaign,
                                               const std::vector<std::vector<DriveScore>>& scores) {
  std::vector<ArmStatistics> statistics;
  for (std::size_t arm = 0; arm < scores.size(); ++arm) {
    ArmStatistics of_arm;
    of_arm.over_seeds = summarise(scores[arm]);
    for (const auto& metric : campaign_metrics()) {
      const auto mine = values(scores[arm], metric);
      of_arm.means.push_back(paired_difference(mine, std::vector<double>(mine.size(), 0.0)));
      if (arm != campaign.baseline)
        of_arm.differences.push_back(
            paired_difference(mine, values(scores[campaign.baseline], metric)));
    }
    statistics.push_back(std::move(of_arm));
  }
  return statistics;
}

}  // namespace vigia::evaluation
