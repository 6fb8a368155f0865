#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vigia/mission/setup.hpp"

namespace vigia::app {

/// A control area in the table of a plan.
struct PlanRow {
  std::size_t area = 0;
  double from_m = 0.0;
  double to_m = 0.0;
  std::vector<Eigen::Vector2d> positions;
  std::vector<LandmarkId> visible;
  std::optional<LandmarkId> chosen;
  double suitability = 0.0;  ///< of the chosen, by the first supervisor, whatever the policy
  std::optional<double> zoom_mm;
  std::vector<LandmarkId> preselected;
};

/// The paper's Table 1 for a mission and a policy.
struct PlanTable {
  std::string mission;
  std::string policy;
  std::vector<double> turn_points;
  std::vector<PlanRow> rows;
};

/// The fuzzy policy's table is its plan. Another policy is asked at each control position, with the
/// uncertainty of the first limit, and the landmark named most often stands in the table; the
/// preselected are all those that it named.
PlanTable make_plan(const mission::MissionSetup& setup, const std::string& policy);

/// How near the route comes to what the map knows, and where: a line's text, or nothing in a world
/// without walls.
std::string tightest_text(const mission::MissionSetup& setup);

/// Draws the plan on its floor: control areas, the chosen landmarks and the sight lines to them.
void draw_plan(const PlanTable& table, const mission::MissionSetup& setup,
               const std::filesystem::path& png);

/// The tables as JSON.
std::string plan_json(const std::vector<PlanTable>& tables);

}  // namespace vigia::app
