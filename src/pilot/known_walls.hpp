#pragma once

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/range_scan.hpp"

namespace vigia::pilot {

/// How far the belief may be off, standard deviations.
struct PoseDoubt {
  double position_m = 0.0;
  double heading = 0.0;  ///< rad
};

/// Whether an echo of a robot believed at @p base may come from a face of the plan: some face lies
/// inside the beam's cone, widened by the doubt about the heading, at the echo's range give or take
/// four standard deviations of reading and position.
bool explained(const RangeReading& reading, const FloorPlan& plan, const Pose2& base,
               const PoseDoubt& doubt, double half_angle, double range_sigma_m);

}  // namespace vigia::pilot
