#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace vigia::planner {

/// A zoom group that would do in one control area.
struct ZoomOption {
  std::size_t group = 0;
  double zoom_mm = 0.0;
  double value = 0.0;  ///< suitability of its best landmark
};

/// For each area the index of the option taken, nothing where there is none: the sequence with the
/// fewest changes of group and, among those, the greatest sum of value − cost_per_mm·|Δzoom|.
std::vector<std::optional<std::size_t>> schedule_zoom(
    const std::vector<std::vector<ZoomOption>>& areas, double cost_per_mm);

}  // namespace vigia::planner
