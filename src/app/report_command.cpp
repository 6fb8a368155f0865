#include "campaign_figures.hpp"
#include "commands.hpp"
#include "replay_recorder.hpp"
#include "run_again.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<std::string> folders;
  std::string out;
};

report::ReplayRun replayed(const fs::path& folder) {
  const mission::MissionSetup setup = mission::load_mission(mission_file(folder));
  evaluation::DriveScorer scorer;
  ReplayRecorder recorder(scorer);
  const std::string note = run_again(folder, setup, scorer, {&recorder});
  report::ReplayRun run = recorder.run(fmt::format("vigia run {}", mission_file(folder).string()));
  run.note = note;
  return run;
}

/// Whether it is a campaign's: one that has both files is a run folder.
bool is_campaign(const fs::path& folder) {
  if (fs::exists(folder / "mission.yaml")) return false;
  const auto there = [&](const char* name) { return fs::exists(folder / name); };
  return there("results.csv") || there("campaign.json") || there("plan.json") || there("missions");
}

int report_campaign(const ReportOptions& options) {
  if (options.folders.size() > 1)
    throw InputError(
        fmt::format("found {} folders, a campaign's among them; must be run folders, "
                    "or one campaign's",
                    options.folders.size()));
  const fs::path folder = options.folders.front();
  const fs::path out = options.out.empty() ? folder / "report.html" : fs::path(options.out);
  write_file(out, campaign_page_of(folder));
  fmt::print("{}\n", out.string());
  return 0;
}

int report(const ReportOptions& options) {
  if (std::any_of(options.folders.begin(), options.folders.end(), is_campaign))
    return report_campaign(options);
  std::vector<report::ReplayRun> runs;
  for (const std::string& folder : options.folders) runs.push_back(replayed(folder));
  fs::path out = options.out;
  if (out.empty())
    out = runs.size() == 1 ? fs::path(options.folders.front()) / "report.html" : "comparison.html";
  write_file(out, report::replay_page(runs));
  fmt::print("{}\n", out.string());
  return 0;
}

}  // namespace

void add_report(CLI::App& app, int& status) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand(
      "report",
      "Drive missions of run folders again and replay them on one page, or make a campaign's page");
  command->add_option("folders", options->folders, "Run folders, or one campaign's folder")
      ->required();
  command->add_option("-o,--out", options->out,
                      "The page (default report.html in the folder; of several folders "
                      "comparison.html here)");
  command->callback([options, &status] { status = report(*options); });
}

}  // namespace vigia::app
