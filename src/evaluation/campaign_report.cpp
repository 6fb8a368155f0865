#include "vigia/evaluation/campaign_report.hpp"

#include "score_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "vigia/core/angle.hpp"
#include "vigia/evaluation/provenance.hpp"
#include "vigia/evaluation/text_table.hpp"

namespace vigia::evaluation {
namespace {

std::string figure(const Estimate& e, double factor, int digits) {
  return fmt::format("{:.{}f} [{:.{}f}, {:.{}f}]", factor * e.value, digits,
                     factor * e.interval.low, digits, factor * e.interval.high, digits);
}

std::string share(int count, int of, const Interval& interval) {
  return fmt::format("{}/{} [{:.1f}, {:.1f}] %", count, of, 100 * interval.low,
                     100 * interval.high);
}

Json json_of(const Estimate& e) {
  return {{"value", e.value}, {"low", e.interval.low}, {"high", e.interval.high}};
}

Json share_json(int count, int of, const Interval& interval) {
  return {{"count", count}, {"of", of}, {"low", interval.low}, {"high", interval.high}};
}

Json metrics_json(const std::vector<Estimate>& estimates) {
  Json json = Json::object();
  for (std::size_t i = 0; i < estimates.size(); ++i)
    json[campaign_metrics()[i].key] = json_of(estimates[i]);
  return json;
}

int recoveries_of(const LossScore& loss) {
  return loss.right_recoveries + loss.wrong_recoveries;
}

Json localizer_json_of(const LocalizerStatistics& l) {
  return {{"position_final_m", json_of(l.position_final)},
          {"heading_final_rad", json_of(l.heading_final)},
          {"position_rmse_m", json_of(l.position_rmse)},
          {"position_max_m", json_of(l.position_max)},
          {"pcrlb_position_rms_m", l.bound_rms},
          {"pcrlb_ratio", json_of(l.pcrlb_ratio)},
          {"nees_per_dof", l.nees_per_dof},
          {"anees_in_band", l.anees_in_band},
          {"anees_looks", l.anees.size()},
          {"anees_per_dof", l.anees},
          {"loss", loss_json(l.loss)},
          {"right_recoveries",
           share_json(l.loss.right_recoveries, recoveries_of(l.loss), l.right_recoveries_share)}};
}

Json arm_json(const Arm& arm, const ArmStatistics& statistics) {
  const SeedStatistics& s = statistics.over_seeds;
  Json json{
      {"name", arm.name},
      {"policy", arm.setup.look.policy},
      {"localizer", arm.setup.primary},
      {"disturbance", arm.disturbance},
      {"variant", arm.variant},
      {"runs", s.runs},
      {"arrived", share_json(s.arrived, s.runs, s.arrived_share)},
      {"collided", share_json(s.collided, s.runs, s.collided_share)},
      {"lost",
       {{"episodes", s.losses.episodes},
        {"false_alarms", s.losses.false_alarms},
        {"false_alarms_per_drive", s.losses.false_alarms / static_cast<double>(s.runs)},
        {"false_alarms_per_km", json_of(s.losses.false_alarms_per_km)},
        {"drives_without_false_alarm",
         share_json(s.losses.drives_without, s.runs, s.losses.drives_without_share)},
        {"losses", s.losses.losses},
        {"beyond_half_metre", s.losses.beyond},
        {"announced", share_json(s.losses.announced, s.losses.losses, s.losses.announced_share)},
        {"ended", s.losses.ended},
        {"recovered", share_json(s.losses.ended, s.losses.episodes, s.losses.ended_share)},
        {"mean_lost_s", s.losses.mean_lost_s},
        {"ambiguous_share", s.losses.ambiguous_share}}},
      {"means", metrics_json(statistics.means)},
      {"differences", metrics_json(statistics.differences)},
      {"localizers", Json::object()}};
  for (const auto& [name, l] : s.localizers) json["localizers"][name] = localizer_json_of(l);
  return json;
}

std::string said_in_time(const LossStatistics& losses) {
  return losses.losses == 0 ? "–" : share(losses.announced, losses.losses, losses.announced_share);
}

std::string found_again(const LossStatistics& losses) {
  return losses.episodes == 0 ? "–" : share(losses.ended, losses.episodes, losses.ended_share);
}

std::string right_recoveries(const LocalizerStatistics& l) {
  const int all = recoveries_of(l.loss);
  return all == 0 ? "–" : share(l.loss.right_recoveries, all, l.right_recoveries_share);
}

TextRows arm_rows(const Campaign& campaign, const std::vector<ArmStatistics>& statistics) {
  TextRows rows{{"arm", "arrived", "collided"}};
  for (const auto& metric : campaign_metrics()) rows.front().push_back(metric.label);
  for (const char* label :
       {"PCRLB ratio", "NEES/dof", "ANEES in band", "times lost", "said before 50 cm",
        "found again", "false alarms", "/km", "drives without", "misses", "delay s",
        "recoveries right", "ambiguous", "Brier"})
    rows.front().emplace_back(label);
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    const SeedStatistics& s = statistics[i].over_seeds;
    const auto& l = s.localizers.at(campaign.arms[i].setup.primary);
    std::vector<std::string> row{campaign.arms[i].name, share(s.arrived, s.runs, s.arrived_share),
                                 std::to_string(s.collided)};
    for (std::size_t m = 0; m < campaign_metrics().size(); ++m)
      row.push_back(figure(statistics[i].means[m], campaign_metrics()[m].factor,
                           campaign_metrics()[m].digits));
    row.push_back(figure(l.pcrlb_ratio, 1, 3));
    row.push_back(fmt::format("{:.3f}", l.nees_per_dof));
    row.push_back(fmt::format("{:.0f} % of {}", 100 * l.anees_in_band, l.anees.size()));
    row.push_back(std::to_string(s.losses.losses));
    row.push_back(said_in_time(s.losses));
    row.push_back(found_again(s.losses));
    row.push_back(std::to_string(s.losses.false_alarms));
    row.push_back(figure(s.losses.false_alarms_per_km, 1, 1));
    row.push_back(share(s.losses.drives_without, s.runs, s.losses.drives_without_share));
    row.push_back(std::to_string(l.loss.misses));
    row.push_back(l.loss.said == 0 ? "–" : fmt::format("{:.1f}", l.loss.delay_mean_s));
    row.push_back(right_recoveries(l));
    row.push_back(fmt::format("{:.1f} %", 100 * s.losses.ambiguous_share));
    row.push_back(fmt::format("{:.4f}", l.loss.brier));
    rows.push_back(row);
  }
  return rows;
}

TextRows difference_rows(const Campaign& campaign, const std::vector<ArmStatistics>& statistics) {
  TextRows rows{{"arm"}};
  for (const auto& metric : campaign_metrics()) rows.front().push_back(metric.label);
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    if (i == campaign.baseline) continue;
    std::vector<std::string> row{campaign.arms[i].name};
    for (std::size_t m = 0; m < campaign_metrics().size(); ++m)
      row.push_back(figure(statistics[i].differences[m], campaign_metrics()[m].factor,
                           campaign_metrics()[m].digits));
    rows.push_back(row);
  }
  return rows;
}

/// An arm has more columns than a terminal: there they become rows.
TextRows transposed(const TextRows& rows) {
  TextRows result(rows.front().size(), std::vector<std::string>(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < rows[r].size(); ++c) result[c][r] = rows[r][c];
  return result;
}

/// At most so many arms beside each other on a terminal.
constexpr std::size_t kAbreast = 4;

std::string in_blocks(const TextRows& rows) {
  std::string text;
  for (std::size_t first = 1; first < rows.size(); first += kAbreast) {
    TextRows block{rows.front()};
    for (std::size_t i = first; i < std::min(first + kAbreast, rows.size()); ++i)
      block.push_back(rows[i]);
    text += (first > 1 ? "\n" : "") + aligned_table(transposed(block));
  }
  return text;
}

std::string localizer_text(const std::string& name, const LocalizerStatistics& l) {
  std::string text = name + "\n";
  text += fmt::format("  final position  {} cm\n", figure(l.position_final, 100, 2));
  text += fmt::format("  final heading   {} °\n", figure(l.heading_final, to_deg(1.0), 3));
  text += fmt::format("  path RMS        {} cm, the bound's {:.2f} cm\n",
                      figure(l.position_rmse, 100, 2), 100 * l.bound_rms);
  text += fmt::format("  path maximum    {} cm\n", figure(l.position_max, 100, 2));
  text += fmt::format("  PCRLB ratio     {}\n", figure(l.pcrlb_ratio, 1, 3));
  text += fmt::format("  NEES per dof    {:.3f} over time", l.nees_per_dof);
  if (!l.anees.empty())
    text +=
        fmt::format("; ANEES in its 95 % band at {:.0f} % of {} looks:\n                  {:.2f}",
                    100 * l.anees_in_band, l.anees.size(), fmt::join(l.anees, " "));
  const LossScore& loss = l.loss;
  text += fmt::format(
      "\n  lost and found  false alarms {} ({:.1f} per km), misses {} ({} over 50 cm), said {} "
      "after "
      "{:.1f} s (at most {:.1f}),\n                  recoveries right {}, ambiguous {:.1f} s, "
      "Brier {:.4f}",
      loss.false_alarms, loss.false_alarms_per_km(), loss.misses, loss.misses_over_half_metre,
      loss.said, loss.delay_mean_s, loss.delay_max_s, right_recoveries(l), loss.ambiguous_s,
      loss.brier);
  return text + "\n";
}

/// All that is known of a campaign of one arm.
std::string single_text(const Campaign& campaign, const ArmStatistics& statistics) {
  const SeedStatistics& s = statistics.over_seeds;
  std::string text = fmt::format("{}: {} seeds from {}, policy {}\n", campaign.name, s.runs,
                                 campaign.first_seed, campaign.arms.front().setup.look.policy);
  text += fmt::format("arrived {} of {} [{:.1f} %, {:.1f} %], collided {}\n", s.arrived, s.runs,
                      100 * s.arrived_share.low, 100 * s.arrived_share.high, s.collided);
  text += fmt::format("looks {}, centring {} px rms\n", figure(s.looks, 1, 1),
                      figure(s.centring_rms_px, 1, 2));
  const auto& metrics = campaign_metrics();
  for (std::size_t m = 0; m < metrics.size(); ++m)
    for (const char* key : {"stops", "stopped_s", "lost_s", "sim_s"})
      if (metrics[m].key == key)
        text += fmt::format("{} {}{}", metrics[m].label,
                            figure(statistics.means[m], metrics[m].factor, metrics[m].digits),
                            metrics[m].key == "sim_s" ? "\n" : ", ");
  text += fmt::format(
      "times lost {} ({} beyond 50 cm), said before 50 cm {}, found again {}, ambiguous {:.1f} % "
      "of "
      "the time\nfalse alarms {} ({:.3f} per drive, {} per km), drives without {}\n\n"
      "means over seeds [95 %]\n",
      s.losses.losses, s.losses.beyond, said_in_time(s.losses), found_again(s.losses),
      100 * s.losses.ambiguous_share, s.losses.false_alarms,
      s.losses.false_alarms / static_cast<double>(s.runs),
      figure(s.losses.false_alarms_per_km, 1, 2),
      share(s.losses.drives_without, s.runs, s.losses.drives_without_share));
  for (const auto& [name, l] : s.localizers) text += localizer_text(name, l);
  return text;
}

std::string heading(const Campaign& campaign) {
  return fmt::format("{}: {} arms × {} seeds from {}", campaign.name, campaign.arms.size(),
                     campaign.seeds, campaign.first_seed);
}

std::string difference_heading(const Campaign& campaign) {
  return fmt::format("differences from {}, paired by seed", campaign.arms[campaign.baseline].name);
}

}  // namespace

std::string campaign_csv(const Campaign& campaign,
                         const std::vector<std::vector<DriveScore>>& scores) {
  std::string text =
      "seed,outcome,sim_s,looks,stops,localizer,position_final_m,heading_final_rad,"
      "position_rmse_m,position_max_m,nees_mean,pcrlb_position_rms_m,lost_s,arm,policy,primary,"
      "disturbance,variant,stopped_s,lost_episodes,lost_announced,lost_ended,"
      "lost_false_alarms\n";
  for (std::size_t arm = 0; arm < scores.size(); ++arm)
    for (const auto& score : scores[arm])
      for (const auto& [name, l] : score.localizers) {
        int announced = 0;
        int ended = 0;
        int false_alarms = 0;
        for (const auto& episode : l.lost) {
          announced += episode.announced() ? 1 : 0;
          ended += episode.ended_s ? 1 : 0;
          false_alarms += episode.false_alarm() ? 1 : 0;
        }
        text += fmt::format(
            "{},{},{:.3f},{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.6f},{:.2f},"
            "{},{},{},{},{},{:.2f},{},{},{},{}\n",
            score.seed, to_string(score.outcome), score.sim_s, score.perception.looks,
            score.perception.stops, name, l.position_final_m, l.heading_final_rad,
            l.position_rmse_m, l.position_max_m, l.nees_mean, l.pcrlb_position_rms_m, l.lost_s,
            campaign.arms[arm].name, campaign.arms[arm].setup.look.policy, score.primary,
            campaign.arms[arm].disturbance, campaign.arms[arm].variant, score.perception.stopped_s,
            l.lost.size(), announced, ended, false_alarms);
      }
  return text;
}

std::string campaign_json(const Campaign& campaign, const std::vector<ArmStatistics>& statistics,
                          const std::vector<WorstMission>& worst,
                          const std::vector<std::string>& programs) {
  Json json{{"campaign", campaign.name},
            {"version", VIGIA_VERSION},
            {"command", campaign.command},
            {"configuration", configuration_of(campaign)},
            {"seeds", {{"first", campaign.first_seed}, {"count", campaign.seeds}}},
            {"baseline", campaign.arms[campaign.baseline].name},
            {"arms", Json::array()}};
  for (std::size_t i = 0; i < statistics.size(); ++i)
    json["arms"].push_back(arm_json(campaign.arms[i], statistics[i]));
  json["worst"] = Json::array();
  for (const WorstMission& m : worst)
    json["worst"].push_back({{"arm", campaign.arms[m.task.arm].name},
                             {"seed", m.task.seed},
                             {"outcome", to_string(m.outcome)},
                             {"position_max_m", m.position_max_m},
                             {"command", repeat_command(m.task, ".")}});
  if (!programs.empty()) json["mixed_programs"] = programs;
  return json.dump(2) + "\n";
}

std::string campaign_text(const Campaign& campaign, const std::vector<ArmStatistics>& statistics) {
  if (statistics.size() == 1) return single_text(campaign, statistics.front());
  return fmt::format("{}, means over seeds [95 %]\n\n{}\n{} [95 %]\n\n{}", heading(campaign),
                     in_blocks(arm_rows(campaign, statistics)), difference_heading(campaign),
                     in_blocks(difference_rows(campaign, statistics)));
}

std::string campaign_markdown(const Campaign& campaign,
                              const std::vector<ArmStatistics>& statistics) {
  std::string text = fmt::format("# {}\n\nMeans over seeds, 95 % intervals.\n\n{}",
                                 heading(campaign), markdown_table(arm_rows(campaign, statistics)));
  if (statistics.size() > 1)
    text += fmt::format("\n## Differences from {}\n\nPaired by seed, 95 % intervals.\n\n{}",
                        campaign.arms[campaign.baseline].name,
                        markdown_table(difference_rows(campaign, statistics)));
  return text;
}

}  // namespace vigia::evaluation
