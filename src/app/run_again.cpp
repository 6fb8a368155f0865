#include "run_again.hpp"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "vigia/core/error.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;

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
         "figures shown are not those of its summary.json.";
}

}  // namespace

fs::path mission_file(const fs::path& folder) {
  fs::path file = folder / "mission.yaml";
  if (!fs::exists(file))
    throw InputError(folder.string() +
                     " is no run folder: there is no mission.yaml; `vigia run` makes one");
  return file;
}

std::string run_again(const fs::path& folder, const mission::MissionSetup& setup,
                      evaluation::DriveScorer& scorer,
                      const std::vector<mission::Listener*>& listeners) {
  std::vector<mission::Listener*> all{&scorer};
  all.insert(all.end(), listeners.begin(), listeners.end());
  mission::run_mission(setup, setup.seed, all);
  std::string note = compared(folder, evaluation::summary_json(scorer.score()));
  if (!note.empty()) spdlog::warn("{}: {}", folder.string(), note);
  return note;
}

}  // namespace vigia::app
