#include "vigia/evaluation/seed_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vigia::evaluation {
namespace {

/// Of the bootstrap, the same in every report.
constexpr std::uint64_t kBootstrapSeed = 1;

template <typename Value>
Estimate mean_of(const std::vector<DriveScore>& scores, Value value) {
  std::vector<double> values;
  values.reserve(scores.size());
  for (const auto& score : scores) values.push_back(value(score));
  return paired_difference(values, std::vector<double>(values.size(), 0.0));
}

/// NEES at the last fused reading of each look that every drive made.
std::vector<std::vector<double>> look_nees(const std::vector<DriveScore>& scores,
                                           const std::string& name) {
  std::size_t looks = scores.front().localizers.at(name).looks.size();
  for (const auto& score : scores) looks = std::min(looks, score.localizers.at(name).looks.size());
  std::vector<std::vector<double>> nees(scores.size());
  for (std::size_t run = 0; run < scores.size(); ++run)
    for (std::size_t k = 0; k < looks; ++k)
      nees[run].push_back(scores[run].localizers.at(name).looks[k].nees);
  return nees;
}

/// Of a share of episodes; nothing is known of it where there were none.
Interval share_of(int count, int episodes) {
  return episodes > 0 ? clopper_pearson(count, episodes) : Interval{0.0, 1.0};
}

Estimate rate_per_km(int count, double driven_m) {
  if (driven_m <= 0.0) return {0.0, {0.0, std::numeric_limits<double>::infinity()}};
  const Interval mean = poisson_mean(count);
  const double km = driven_m / 1000.0;
  return {count / km, {mean.low / km, mean.high / km}};
}

LocalizerStatistics localizer_statistics(const std::vector<DriveScore>& scores,
                                         const std::string& name) {
  const auto mean = [&](double LocalizerScore::*part) {
    return mean_of(scores, [&](const DriveScore& s) { return s.localizers.at(name).*part; });
  };
  LocalizerStatistics statistics;
  statistics.position_final = mean(&LocalizerScore::position_final_m);
  statistics.heading_final = mean(&LocalizerScore::heading_final_rad);
  statistics.position_rmse = mean(&LocalizerScore::position_rmse_m);
  statistics.position_max = mean(&LocalizerScore::position_max_m);
  statistics.nees_per_dof = mean(&LocalizerScore::nees_mean).value / 3.0;

  std::vector<double> errors;
  std::vector<double> bounds;
  double bound_sum = 0.0;
  for (const auto& score : scores) {
    const auto& s = score.localizers.at(name);
    errors.push_back(s.position_rmse_m * s.position_rmse_m);
    bounds.push_back(s.pcrlb_position_rms_m * s.pcrlb_position_rms_m);
    bound_sum += bounds.back();
  }
  statistics.bound_rms = std::sqrt(bound_sum / static_cast<double>(scores.size()));
  statistics.pcrlb_ratio = evaluation::pcrlb_ratio(errors, bounds, kBootstrapSeed);

  std::vector<LossScore> losses;
  losses.reserve(scores.size());
  for (const auto& score : scores) losses.push_back(score.localizers.at(name).loss);
  statistics.loss = combined(losses);
  statistics.right_recoveries_share =
      share_of(statistics.loss.right_recoveries,
               statistics.loss.right_recoveries + statistics.loss.wrong_recoveries);

  const auto nees = look_nees(scores, name);
  if (!nees.front().empty()) {
    const Anees over_looks = anees(nees, 3);
    statistics.anees = over_looks.per_dof;
    statistics.anees_in_band = over_looks.inside_band;
  }
  return statistics;
}

LossStatistics loss_statistics(const std::vector<DriveScore>& scores) {
  LossStatistics losses;
  double lost_s = 0.0;
  double ambiguous_s = 0.0;
  double driven_m = 0.0;
  double sim_s = 0.0;
  for (const auto& score : scores) {
    const LocalizerScore& primary = score.localizers.at(score.primary);
    ambiguous_s += primary.loss.ambiguous_s;
    driven_m += primary.loss.driven_m;
    sim_s += score.sim_s;
    const int alarms_before = losses.false_alarms;
    for (const auto& episode : primary.lost) {
      ++losses.episodes;
      if (episode.false_alarm()) ++losses.false_alarms;
      if (episode.passed_s) ++losses.beyond;
      if (episode.announced()) ++losses.announced;
      if (!episode.ended_s) continue;
      ++losses.ended;
      lost_s += *episode.ended_s - episode.began_s();
    }
    if (losses.false_alarms == alarms_before) ++losses.drives_without;
  }
  losses.losses = losses.episodes - losses.false_alarms;
  losses.false_alarms_per_km = rate_per_km(losses.false_alarms, driven_m);
  if (sim_s > 0.0) losses.ambiguous_share = ambiguous_s / sim_s;
  losses.drives_without_share =
      clopper_pearson(losses.drives_without, static_cast<int>(scores.size()));
  losses.announced_share = share_of(losses.announced, losses.losses);
  losses.ended_share = share_of(losses.ended, losses.episodes);
  if (losses.ended > 0) losses.mean_lost_s = lost_s / losses.ended;
  return losses;
}

}  // namespace

SeedStatistics summarise(const std::vector<DriveScore>& scores) {
  if (scores.size() < 2) throw std::invalid_argument("statistics need at least two drives");
  SeedStatistics statistics;
  statistics.runs = static_cast<int>(scores.size());
  for (const auto& score : scores) {
    if (score.outcome == mission::Outcome::arrived) ++statistics.arrived;
    if (score.outcome == mission::Outcome::collided) ++statistics.collided;
  }
  statistics.arrived_share = clopper_pearson(statistics.arrived, statistics.runs);
  statistics.collided_share = clopper_pearson(statistics.collided, statistics.runs);
  statistics.losses = loss_statistics(scores);
  statistics.looks =
      mean_of(scores, [](const DriveScore& s) { return static_cast<double>(s.perception.looks); });
  statistics.centring_rms_px =
      mean_of(scores, [](const DriveScore& s) { return s.perception.centring_rms_px; });
  for (const auto& [name, score] : scores.front().localizers)
    statistics.localizers[name] = localizer_statistics(scores, name);
  return statistics;
}

}  // namespace vigia::evaluation
