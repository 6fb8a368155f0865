#include "vigia/evaluation/armingol_table.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vigia::evaluation {
namespace {

const PlanArea* find_area(const std::vector<PlanArea>& plan, int area) {
  const auto found =
      std::find_if(plan.begin(), plan.end(), [area](const PlanArea& a) { return a.area == area; });
  return found == plan.end() ? nullptr : &*found;
}

std::string area_name(const PlanArea* printed, const PlanArea* planned) {
  const PlanArea& known = printed != nullptr ? *printed : *planned;
  std::string name = fmt::format("area {}, visible {}", known.area, fmt::join(known.visible, " "));
  if (printed != nullptr && planned != nullptr && printed->visible != planned->visible)
    name += fmt::format(" (here {})", fmt::join(planned->visible, " "));
  return name;
}

}  // namespace

const std::vector<PlanArea>& armingol_table_1() {
  static const std::vector<PlanArea> printed{
      {0, {0, 4, 6}, 6, 76.0}, {1, {4}, 4, 63.0}, {2, {1, 2, 3}, 2, 93.0}, {3, {1, 2, 3}, 3, 93.0},
      {4, {2, 3, 4}, 2, 97.0}, {5, {4}, 4, 35.0}, {6, {0, 6}, 0, 41.0}};
  return printed;
}

std::vector<PaperRow> table_1_rows(const std::vector<PlanArea>& plan) {
  int areas = 0;
  for (const auto& area : armingol_table_1()) areas = std::max(areas, area.area + 1);
  for (const auto& area : plan) areas = std::max(areas, area.area + 1);
  std::vector<PaperRow> rows;
  for (int i = 0; i < areas; ++i) {
    const PlanArea* printed = find_area(armingol_table_1(), i);
    const PlanArea* planned = find_area(plan, i);
    if (printed == nullptr && planned == nullptr) continue;
    PaperRow chosen{area_name(printed, planned) + ": chosen landmark", "id"};
    PaperRow suitability{area_name(printed, planned) + ": suitability", "%"};
    if (printed != nullptr) {
      chosen.published = printed->chosen;
      suitability.published = printed->suitability;
    }
    if (planned != nullptr) {
      chosen.as_published = planned->chosen;
      suitability.as_published = planned->suitability;
    }
    rows.push_back(chosen);
    rows.push_back(suitability);
  }
  return rows;
}

}  // namespace vigia::evaluation
