#pragma once

#include "vigia/planner/look_policy.hpp"

namespace vigia::planner {

/// Where the robot will be when the head has turned to a landmark and the zoom is set.
struct Arrival {
  double seconds = 0.0;
  Pose2 pose;
  double station_m = 0.0;
};

/// Time for pan, tilt and zoom, each from rest to rest, the slowest counting, s.
double travel_time(const HeadReading& from, const HeadAngles& aim, double zoom_mm,
                   const HeadModel& head);

/// Foresees the arrival (Armingol §3.1): the robot follows its path at its speed, unless it stands;
/// the arrival and the aim depend on each other, three rounds settle them. @p zoom_mm: planned, or
/// nothing for the zoom that suits the range.
Arrival foresee(const Landmark& landmark, std::optional<double> zoom_mm,
                const LookContext& context);

/// Whether the landmark can be observed from the arrival until the look's end: not excluded,
/// visible at both, and the pan keeps off its stops meanwhile.
bool can_be_held(const Landmark& landmark, const Arrival& arrival, const LookContext& context);

}  // namespace vigia::planner
