#pragma once

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/ground.hpp"

namespace vigia {

/// Whether no face of the plan stands between two points of the world. On folded ground that is
/// asked of their places in the plan: exact within a patch, and across a fold to the millimetres by
/// which a straight line bends in the plan.
inline bool line_of_sight(const FloorPlan& plan, const Ground& ground, const Eigen::Vector3d& p_w,
                          const Eigen::Vector3d& q_w) {
  return plan.line_of_sight(ground.in_plan(p_w), ground.in_plan(q_w));
}

}  // namespace vigia
