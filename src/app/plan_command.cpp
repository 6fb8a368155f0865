#include "commands.hpp"
#include "plan_table.hpp"
#include "usage_mistake.hpp"

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/error.hpp"
#include "vigia/mission/setup.hpp"
#include "vigia/planner/look_policy.hpp"

namespace vigia::app {
namespace {

struct PlanOptions {
  std::string mission;
  std::vector<std::string> policies;
  std::vector<std::string> overrides;
  std::string out;
  bool json = false;
};

std::string list(const std::vector<LandmarkId>& ids) {
  return fmt::format("{}", fmt::join(ids, ", "));
}

void print(const PlanTable& table) {
  fmt::print("{}, policy {}: {} control areas, {} turn points\n\n", table.mission, table.policy,
             table.rows.size(), table.turn_points.size());
  fmt::print("{:>4}  {:<18} {:<22} {:>8}  {:>12}  {}\n", "area", "visible landmarks", "suitability",
             "zoom mm", "stations m", "preselected");
  for (const PlanRow& row : table.rows)
    fmt::print("{:>4}  {:<18} {:<22} {:>8}  {:>5.1f} – {:>4.1f}  {}\n", row.area, list(row.visible),
               row.chosen ? fmt::format("{:3.0f} % landmark {}", 100 * row.suitability, *row.chosen)
                          : "none",
               row.zoom_mm ? fmt::format("{:.1f}", *row.zoom_mm) : "by size", row.from_m, row.to_m,
               list(row.preselected));
  fmt::print("\n");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw InputError("cannot make the folder " + folder.string() + ": " + failure.message());
}

int plan(PlanOptions options) {
  const auto setup = mission::load_mission(options.mission, options.overrides);
  if (options.policies.empty()) options.policies.push_back(setup.look.policy);
  std::vector<PlanTable> tables;
  for (const std::string& policy : options.policies) tables.push_back(make_plan(setup, policy));
  if (!options.out.empty()) {
    make_folder(options.out);
    for (const PlanTable& table : tables)
      draw_plan(table, setup,
                std::filesystem::path(options.out) /
                    (tables.size() == 1 ? "plan.png" : "plan-" + table.policy + ".png"));
  }
  if (options.json) {
    std::cout << plan_json(tables);
    return 0;
  }
  for (const PlanTable& table : tables) print(table);
  fmt::print("{}\n", tightest_text(setup));
  return 0;
}

}  // namespace

void add_plan(CLI::App& app, int& status) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = app.add_subcommand(
      "plan", "Plan a mission's looks: control areas, landmarks, suitability, zoom");
  command->add_option("mission", options->mission, "Mission file (YAML)")->required();
  command->add_option("--policy", options->policies, "Policy, repeatable (default: the mission's)")
      ->check(one_of(names_of(planner::look_policies())))
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "Folder for the picture plan.png");
  command->add_option("--set", options->overrides, "Override a key of the mission")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--json", options->json, "Print the table as JSON on stdout");
  command->callback([options, &status] { status = plan(*options); });
}

}  // namespace vigia::app
