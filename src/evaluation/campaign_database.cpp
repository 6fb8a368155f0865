#include "vigia/evaluation/campaign_database.hpp"

#include "sqlite_file.hpp"

#include <system_error>

#include <fmt/format.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"
#include "vigia/evaluation/campaign_statistics.hpp"
#include "vigia/evaluation/provenance.hpp"
#include "vigia/evaluation/worst_missions.hpp"

namespace vigia::evaluation {
namespace {

namespace fs = std::filesystem;

/// A file aside is written once and renamed: it needs no journal of its own.
constexpr const char* kSchema = R"(
PRAGMA journal_mode = OFF;
PRAGMA synchronous = OFF;
BEGIN;
CREATE TABLE campaign (
  name TEXT, version TEXT, build TEXT, configuration TEXT, command TEXT,
  first_seed INTEGER, seeds INTEGER, baseline TEXT);
CREATE TABLE arms (
  arm INTEGER PRIMARY KEY, name TEXT, policy TEXT, primary_localizer TEXT, disturbance TEXT,
  variant TEXT, mission_yaml TEXT);
CREATE TABLE missions (
  mission INTEGER PRIMARY KEY, arm INTEGER REFERENCES arms, seed INTEGER, outcome TEXT, sim_s REAL,
  looks INTEGER, stops INTEGER, stopped_s REAL, over_limit_1 INTEGER, over_limit_2 INTEGER,
  zoom_changes INTEGER, pan_travel_rad REAL, centring_rms_px REAL, centring_max_px REAL,
  target_losses INTEGER, lost INTEGER, recovered INTEGER, recovering_s REAL, command TEXT);
CREATE TABLE localizers (
  mission INTEGER REFERENCES missions, localizer TEXT, position_final_m REAL, position_rmse_m REAL,
  position_max_m REAL, heading_final_rad REAL, heading_rmse_rad REAL, nees_mean REAL,
  pcrlb_position_rms_m REAL, pcrlb_position_final_m REAL, pcrlb_heading_final_rad REAL,
  updates INTEGER, rejected INTEGER, unsupported INTEGER, lost_s REAL, false_alarms INTEGER,
  misses INTEGER, driven_m REAL, right_recoveries INTEGER, wrong_recoveries INTEGER,
  ambiguous_s REAL, brier REAL, PRIMARY KEY (mission, localizer)) WITHOUT ROWID;
CREATE TABLE looks (
  mission INTEGER REFERENCES missions, localizer TEXT, look INTEGER, nees REAL,
  squared_error_m2 REAL, bound_m2 REAL, PRIMARY KEY (mission, localizer, look)) WITHOUT ROWID;
CREATE TABLE losses (
  mission INTEGER REFERENCES missions, localizer TEXT, number INTEGER, said_s REAL,
  passed_half_metre_s REAL, ended_s REAL, false_alarm INTEGER, PRIMARY KEY (mission, localizer, number)) WITHOUT ROWID;
)";

void add_campaign(SqliteFile& file, const Campaign& campaign) {
  const Provenance p = provenance_of(campaign);
  file.insert("campaign", p.campaign, p.version, p.build, p.configuration, p.command,
              static_cast<std::int64_t>(campaign.first_seed), campaign.seeds,
              campaign.arms[campaign.baseline].name);
  for (std::size_t i = 0; i < campaign.arms.size(); ++i) {
    const Arm& arm = campaign.arms[i];
    file.insert("arms", static_cast<std::int64_t>(i), arm.name, arm.setup.look.policy,
                arm.setup.primary, arm.disturbance, arm.variant, arm.setup.resolved_yaml);
  }
}

void add_localizer(SqliteFile& file, std::int64_t mission, const std::string& name,
                   const LocalizerScore& s) {
  file.insert("localizers", mission, name, s.position_final_m, s.position_rmse_m, s.position_max_m,
              s.heading_final_rad, s.heading_rmse_rad, s.nees_mean, s.pcrlb_position_rms_m,
              s.pcrlb_position_final_m, s.pcrlb_heading_final_rad, s.updates, s.rejected,
              s.unsupported, s.lost_s, s.loss.false_alarms, s.loss.misses, s.loss.driven_m,
              s.loss.right_recoveries, s.loss.wrong_recoveries, s.loss.ambiguous_s, s.loss.brier);
}

void add_mission(SqliteFile& file, std::int64_t mission, std::size_t arm, const DriveScore& s) {
  const PerceptionScore& p = s.perception;
  file.insert("missions", mission, static_cast<std::int64_t>(arm),
              static_cast<std::int64_t>(s.seed), to_string(s.outcome), s.sim_s, p.looks, p.stops,
              p.stopped_s, p.over_limit_1, p.over_limit_2, p.zoom_changes, p.pan_travel_rad,
              p.centring_rms_px, p.centring_max_px, p.target_losses, s.recovery.lost,
              s.recovery.recovered, s.recovery.recovering_s, repeat_command({arm, s.seed}, "."));
}

/// Table by table: the statement of a table is prepared once.
void add_missions(SqliteFile& file, const std::vector<std::vector<DriveScore>>& scores) {
  const auto each = [&](auto add) {
    std::int64_t mission = 0;
    for (std::size_t arm = 0; arm < scores.size(); ++arm)
      for (const DriveScore& score : scores[arm]) add(mission++, arm, score);
  };
  const auto each_localizer = [&](auto add) {
    each([&](std::int64_t mission, std::size_t, const DriveScore& score) {
      for (const auto& [name, s] : score.localizers) add(mission, name, s);
    });
  };
  each([&](std::int64_t mission, std::size_t arm, const DriveScore& score) {
    add_mission(file, mission, arm, score);
  });
  each_localizer([&](std::int64_t mission, const std::string& name, const LocalizerScore& s) {
    add_localizer(file, mission, name, s);
  });
  each_localizer([&](std::int64_t mission, const std::string& name, const LocalizerScore& s) {
    for (const LookScore& look : s.looks)
      file.insert("looks", mission, name, static_cast<std::int64_t>(look.look), look.nees,
                  look.squared_error_m2, look.bound_m2);
  });
  each_localizer([&](std::int64_t mission, const std::string& name, const LocalizerScore& s) {
    for (std::size_t i = 0; i < s.lost.size(); ++i)
      file.insert("losses", mission, name, static_cast<std::int64_t>(i), s.lost[i].said_s,
                  s.lost[i].passed_s, s.lost[i].ended_s, s.lost[i].false_alarm() ? 1 : 0);
  });
}

}  // namespace

void write_database(const fs::path& path, const Campaign& campaign,
                    const std::vector<std::vector<DriveScore>>& scores) {
  const fs::path aside = path.string() + own_part_suffix();
  std::error_code error;
  try {
    SqliteFile file(aside);
    file.execute(kSchema);
    add_campaign(file, campaign);
    add_missions(file, scores);
    file.execute("COMMIT");
    file.close();
    fs::rename(aside, path, error);
  } catch (...) {
    fs::remove(aside, error);
    throw;
  }
  if (error) throw InputError("cannot write " + path.string() + ": " + error.message());
}

std::string ompl_benchmark_log(const Campaign& campaign,
                               const std::vector<std::vector<DriveScore>>& scores) {
  const Provenance p = provenance_of(campaign);
  double total_s = 0.0;
  for (const auto& arm : scores)
    for (const DriveScore& score : arm) total_s += score.sim_s;
  std::string text = fmt::format(
      "vigia version {}\nExperiment {}\n2 experiment properties\nconfiguration TEXT = {}\n"
      "command TEXT = {}\nRunning on simulation\nStarting at\n<<<|\nsimulated seconds\n|>>>\n"
      "{} is the random seed\n{} seconds per run\n0 MB per run\n{} runs per planner\n"
      "{} seconds spent to collect the data\n1 enum type\n"
      "outcome|arrived|collided|timeout|stuck|lost\n{} planners\n",
      p.version, p.campaign, p.configuration, p.command, campaign.first_seed,
      campaign.arms.front().setup.timeout_s, campaign.seeds, total_s, scores.size());
  for (std::size_t arm = 0; arm < scores.size(); ++arm) {
    text += fmt::format("{}\n0 common properties\n{} properties for each run\n",
                        campaign.arms[arm].name, 4 + campaign_metrics().size());
    text += "solved BOOLEAN\ntime REAL\nseed INTEGER\noutcome ENUM\n";
    for (const CampaignMetric& metric : campaign_metrics()) text += metric.key + " REAL\n";
    text += fmt::format("{} runs\n", scores[arm].size());
    for (const DriveScore& score : scores[arm]) {
      text += fmt::format("{}; {}; {}; {}; ", score.outcome == mission::Outcome::arrived ? 1 : 0,
                          score.sim_s, score.seed, static_cast<int>(score.outcome));
      for (const CampaignMetric& metric : campaign_metrics())
        text += fmt::format("{}; ", metric.value(score));
      text += "\n";
    }
    text += ".\n";
  }
  return text;
}

}  // namespace vigia::evaluation
