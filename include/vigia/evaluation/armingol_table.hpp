#pragma once

#include <vector>

#include "vigia/core/landmark.hpp"
#include "vigia/evaluation/paper_table.hpp"

namespace vigia::evaluation {

/// A control area of a perception plan: Armingol's Table 1 has a row for each.
struct PlanArea {
  int area = 0;  ///< from 0 along the path
  std::vector<LandmarkId> visible;
  LandmarkId chosen = 0;
  double suitability = 0.0;  ///< of the chosen landmark, %
};

/// Armingol's Table 1 as printed.
const std::vector<PlanArea>& armingol_table_1();

/// The rows of a plan beside the printed ones, two for each area: the chosen landmark and its
/// suitability. An area that only one of the two has stands alone; what differs in the visible
/// landmarks is said in the row's name.
std::vector<PaperRow> table_1_rows(const std::vector<PlanArea>& plan);

}  // namespace vigia::evaluation
