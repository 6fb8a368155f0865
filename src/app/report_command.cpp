#include "commands.hpp"
#include "replay_recorder.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<std::string> folders;
  std::string out;
};

/// summary.json without what the program's version changes, or null with @p fault saying why.
struct Summary {
  nlohmann::json values;
  std::string fault;
};

Summary summary_in(const fs::path& folder) {
  constexpr std::uintmax_t kMaxBytes = 16U << 20U;
  const fs::path file = folder / "summary.json";
  std::error_code missing;
  const auto bytes = fs::file_size(file, missing);
  if (missing) return {nullptr, "there is no summary.json"};
  if (bytes > kMaxBytes) return {nullptr, "summary.json is too large to be one"};
  std::ifstream stream(file);
  auto values = nlohmann::json::parse(stream, nullptr, false);
  if (!values.is_object()) return {nullptr, "summary.json is no JSON object"};
  values.erase("version");
  return {values, {}};
}

/// What the page says of a folder whose drive the program no longer repeats.
std::string compared(const fs::path& folder, const std::string& summary_json) {
  const Summary found = summary_in(folder);
  if (!found.fault.empty()) return fmt::format("Driven again from mission.yaml: {}.", found.fault);
  auto again = nlohmann::json::parse(summary_json);
  again.erase("version");
  if (found.values == again) return {};
  return "Driven again from mission.yaml, and this program's drive differs from the folder's: the "
         "figures on this page are not those of its summary.json.";
}

report::ReplayRun replayed(const fs::path& folder) {
  const fs::path mission_file = folder / "mission.yaml";
  if (!fs::exists(mission_file))
    throw InputError(folder.string() +
                     " is no run folder: there is no mission.yaml; `vigia run` makes one");
  const mission::MissionSetup setup = mission::load_mission(mission_file);
  evaluation::DriveScorer scorer;
  ReplayRecorder recorder(scorer);
  mission::run_mission(setup, setup.seed, {&scorer, &recorder});
  report::ReplayRun run = recorder.run(fmt::format("vigia run {}", mission_file.string()));
  run.note = compared(folder, run.summary_json);
  if (!run.note.empty()) spdlog::warn("{}: {}", folder.string(), run.note);
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
