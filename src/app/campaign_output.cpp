#include "campaign_output.hpp"

#include "campaign_figures.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "vigia/core/output_file.hpp"
#include "vigia/evaluation/campaign_database.hpp"
#include "vigia/evaluation/campaign_report.hpp"
#include "vigia/report/arms_picture.hpp"

namespace vigia::app {
namespace {

constexpr std::size_t kWorst = 5;

report::ArmValue arm_value(const evaluation::Estimate& e, double factor) {
  return {factor * e.value, factor * e.interval.low, factor * e.interval.high};
}

report::ArmsPicture picture_of(const evaluation::Campaign& campaign,
                               const std::vector<evaluation::ArmStatistics>& statistics) {
  report::ArmsPicture picture;
  picture.title = campaign.name;
  picture.subtitle =
      fmt::format("{} seeds from {}, the same for every arm; mission {}", campaign.seeds,
                  campaign.first_seed, campaign.arms.front().setup.name);
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    const auto& arm = campaign.arms[i];
    const auto& s = statistics[i].over_seeds;
    picture.arms.push_back({arm.name, arm.setup.look.policy + ", " + arm.setup.primary,
                            arm_value(s.looks, 1.0),
                            arm_value(s.localizers.at(arm.setup.primary).position_rmse, 100.0)});
  }
  return picture;
}

}  // namespace

void CampaignOutput::add_options(CLI::App& command) {
  command.add_option("--csv", csv, "Write results.csv to this file too");
  command.add_option("--sqlite", sqlite, "Write the results as this SQLite file");
  command.add_option("--ompl-log", ompl,
                     "Write the results as this log, for ompl_benchmark_statistics");
  command.add_flag("--json", json, "Print summary.json on stdout");
}

int write_campaign(const std::filesystem::path& folder, const evaluation::Campaign& campaign,
                   std::map<evaluation::CampaignTask, evaluation::DriveScore> finished,
                   const CampaignOutput& output, const std::vector<std::string>& programs) {
  const auto scores = evaluation::scores_by_arm(campaign, std::move(finished));
  const auto statistics = evaluation::campaign_statistics(campaign, scores);
  const auto worst = evaluation::worst_missions(scores, kWorst);
  const std::string csv = evaluation::campaign_csv(campaign, scores);
  const std::string json = evaluation::campaign_json(campaign, statistics, worst, programs);
  write_file(folder / "results.csv", csv);
  write_file(folder / "table.md", evaluation::campaign_markdown(campaign, statistics));
  report::draw_arms(picture_of(campaign, statistics), folder / "arms.png");
  write_file(folder / "summary.json", json);
  write_file(folder / "report.html", campaign_page_of(folder));
  if (!output.csv.empty()) write_file(output.csv, csv);
  if (!output.sqlite.empty()) evaluation::write_database(output.sqlite, campaign, scores);
  if (!output.ompl.empty())
    write_file(output.ompl, evaluation::ompl_benchmark_log(campaign, scores));
  if (output.json)
    fmt::print("{}", json);
  else
    fmt::print("{}\n{}\nfolder: {}\npage:   {}/report.html\n",
               evaluation::campaign_text(campaign, statistics),
               evaluation::worst_missions_text(campaign, worst, folder), folder.string(),
               folder.string());
  const bool all_arrived = std::all_of(statistics.begin(), statistics.end(), [](const auto& arm) {
    return arm.over_seeds.arrived == arm.over_seeds.runs;
  });
  return all_arrived ? 0 : 1;
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("-j,--threads", threads, "Threads (default: all cores)")
      ->check(CLI::Range(1, 1024));
}

int threads_of(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace vigia::app
