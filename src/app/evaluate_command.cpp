#include "campaign_progress.hpp"
#include "commands.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/output_file.hpp"
#include "vigia/evaluation/campaign_report.hpp"
#include "vigia/evaluation/campaign_run.hpp"
#include "vigia/report/arms_picture.hpp"

namespace vigia::app {
namespace {

struct EvaluateOptions {
  std::string campaign;
  std::vector<std::string> overrides;
  std::string out;
  std::string csv;
  int threads = 0;
  bool restart = false;
  bool json = false;
  bool quiet = false;
};

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

int evaluate(const EvaluateOptions& options) {
  const auto campaign = evaluation::read_campaign(options.campaign, options.overrides);
  const std::string out = options.out.empty() ? "campaigns/" + campaign.name : options.out;
  evaluation::CampaignJournal journal(out, campaign, options.restart);
  const int threads = options.threads > 0
                          ? options.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  CampaignLine line(options.quiet);
  evaluation::run_campaign(campaign, journal, threads, std::ref(line));
  line.finish(threads);

  const auto scores = evaluation::scores_by_arm(campaign, journal);
  const auto statistics = evaluation::campaign_statistics(campaign, scores);
  const std::string csv = evaluation::campaign_csv(campaign, scores);
  const std::string json = evaluation::campaign_json(campaign, statistics);
  write_file(journal.folder() / "results.csv", csv);
  write_file(journal.folder() / "table.md", evaluation::campaign_markdown(campaign, statistics));
  report::draw_arms(picture_of(campaign, statistics), journal.folder() / "arms.png");
  write_file(journal.folder() / "summary.json", json);
  if (!options.csv.empty()) write_file(options.csv, csv);
  if (options.json)
    fmt::print("{}", json);
  else
    fmt::print("{}\nfolder: {}\n", evaluation::campaign_text(campaign, statistics), out);
  const bool all_arrived = std::all_of(statistics.begin(), statistics.end(), [](const auto& arm) {
    return arm.over_seeds.arrived == arm.over_seeds.runs;
  });
  return all_arrived ? 0 : 1;
}

}  // namespace

void add_evaluate(CLI::App& app, int& status) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command = app.add_subcommand(
      "evaluate", "Drive a campaign's missions and print the statistics; resumes when repeated");
  command->add_option("campaign", options->campaign, "Campaign file (YAML)")->required();
  command->add_option("-j,--threads", options->threads, "Threads (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--out", options->out, "Output folder (default campaigns/<campaign>)");
  command->add_option("--set", options->overrides, "Override a key of the mission in every arm")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--csv", options->csv, "Write results.csv to this file too");
  command->add_flag("--restart", options->restart, "Forget the missions that the folder holds");
  command->add_flag("--json", options->json, "Print summary.json on stdout");
  command->add_flag("--quiet", options->quiet, "No progress line");
  command->callback([options, &status] { status = evaluate(*options); });
}

}  // namespace vigia::app
