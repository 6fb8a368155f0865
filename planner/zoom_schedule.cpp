#include "zoom_schedule.hpp"

#include <cmath>

namespace vigia::planner {
namespace {

/// The best sequence that reaches an option.
struct Reached {
  int changes = 0;
  double value = 0.0;
  std::size_t from = 0;  ///< option of the area before
};

bool better(const Reached& a, const Reached& b) {
  return a.changes != b.changes ? a.changes < b.changes : a.value > b.value;
}

std::vector<Reached> reach(const std::vector<ZoomOption>& options,
                           const std::vector<ZoomOption>& before,
                           const std::vector<Reached>& reached, double cost_per_mm) {
  std::vector<Reached> result;
  for (const ZoomOption& option : options) {
    Reached best{0, option.value, 0};
    for (std::size_t j = 0; j < before.size(); ++j) {
      const int change = option.group != before[j].group ? 1 : 0;
      const double travel = cost_per_mm * std::abs(option.zoom_mm - before[j].zoom_mm);
      const Reached candidate{reached[j].changes + change, reached[j].value + option.value - travel,
                              j};
      if (j == 0 || better(candidate, best)) best = candidate;
    }
    result.push_back(best);
  }
  return result;
}

}  // namespace

std::vector<std::optional<std::size_t>> schedule_zoom(
    const std::vector<std::vector<ZoomOption>>& areas, double cost_per_mm) {
  std::vector<std::size_t> served;  // areas that have an option
  for (std::size_t i = 0; i < areas.size(); ++i)
    if (!areas[i].empty()) served.push_back(i);
  std::vector<std::vector<Reached>> table;
  for (std::size_t k = 0; k < served.size(); ++k)
    table.push_back(k == 0
                        ? reach(areas[served[0]], {}, {}, cost_per_mm)
                        : reach(areas[served[k]], areas[served[k - 1]], table[k - 1], cost_per_mm));

  std::vector<std::optional<std::size_t>> taken(areas.size());
  if (served.empty()) return taken;
  std::size_t option = 0;
  for (std::size_t j = 1; j < table.back().size(); ++j)
    if (better(table.back()[j], table.back()[option])) option = j;
  for (std::size_t k = served.size(); k-- > 0;) {
    taken[served[k]] = option;
    option = table[k][option].from;
  }
  return taken;
}

}  // namespace vigia::planner
