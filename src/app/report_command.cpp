#include "commands.hpp"
#include "replay_recorder.hpp"
#include "run_again.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/output_file.hpp"

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

int report(const ReportOptions& options) {
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
      "report", "Drive missions of run folders again and replay them on one page");
  command->add_option("folders", options->folders, "Run folders")->required();
  command->add_option("-o,--out", options->out,
                      "The page (default report.html in the run folder; of several folders "
                      "comparison.html here)");
  command->callback([options, &status] { status = report(*options); });
}

}  // namespace vigia::app
