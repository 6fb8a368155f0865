#include "run_again.hpp"

#include "object_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "vigia/core/error.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;

/// What is said of a folder whose drive the program no longer repeats.
std::string compared(const fs::path& folder, const std::string& summary_json) {
  ObjectFile found = object_in(folder / "summary.json");
  if (!found.fault.empty()) return fmt::format("Driven again from mission.yaml: {}.", found.fault);
  auto again = nlohmann::ordered_json::parse(summary_json);
  for (auto* each : {&found.values, &again}) each->erase("version");
  // As sets of members: their order is none of the drive's.
  if (nlohmann::json(found.values) == nlohmann::json(again)) return {};
  return "Driven again from mission.yaml, and this program's drive differs from the folder's: the "
         "figures shown are not those of its summary.json.";
}

}  // namespace

fs::path mission_file(const fs::path& folder) {
  fs::path file = folder / "mission.yaml";
  if (!fs::exists(file))
    throw InputError(
        folder.string() +
        " is no run folder: there is no mission.yaml; `vigia run` makes one, and `vigia "
        "evaluate` a campaign's");
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
