#pragma once

#include <vector>

#include "vigia/localization/ceiling_model.hpp"

namespace vigia::localization {

/// What the patches of two frames say of the flow between them.
enum class FlowVerdict {
  silent,       ///< none of the patches is in both
  agrees,       ///< most moved as the flow says
  contradicts,  ///< most moved otherwise, as the robot may have moved
};

/// Whatever looks like a patch, one of the grid's or not, is fixed to the ceiling, and what moves
/// otherwise than it does not show the robot's motion: a shadow's edge, or the light of a door that
/// opens. A patch of the frame before is sought where the flow leads it, and if it is not there
/// wherever a robot could have led it.
/// @p reach_m, @p reach: how far the robot may have gone, and turned (rad), between the frames.
FlowVerdict judge_flow(const std::vector<PatchOnCeiling>& before,
                       const std::vector<PatchOnCeiling>& now, const FlowMotion& flow,
                       double reach_m, double reach, double gate);

}  // namespace vigia::localization
