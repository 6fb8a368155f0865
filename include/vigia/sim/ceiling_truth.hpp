#pragma once

#include <cstdint>
#include <optional>

#include "vigia/core/ceiling_grid.hpp"
#include "vigia/core/pose.hpp"

namespace vigia::sim {

/// A patched ceiling as it truly is. What hangs in a cell is a hash of seed and cell.
struct CeilingTruth {
  CeilingGrid grid;  ///< placement errors are drawn with its σ; the height is the floor plan's
  std::uint64_t seed = 1;
  double missing = 0.0;   ///< share of the cells whose patch has fallen off
  double spurious = 0.0;  ///< share of the cells that have a second patch, anywhere in them
  double patch_grey = 55.0;
  double lamp_pitch_m = 0.0;  ///< between lamps of 1.2 by 0.2 m, midway between patches; 0: none
  double lamp_grey = 252.0;
  double pipe_pitch_m = 0.0;  ///< between pipes along x, which hang before patches; 0: none
  double pipe_width_m = 0.1;
  double pipe_drop_m = 0.1;  ///< of their lower side below the ceiling
};

/// Where the cell's patch truly hangs, seen from above; nothing where none does.
std::optional<Pose2> true_patch(const CeilingTruth& truth, const CeilingCell& cell);
/// The patch that should not be there, if the cell has one.
std::optional<Pose2> spurious_patch(const CeilingTruth& truth, const CeilingCell& cell);

}  // namespace vigia::sim
