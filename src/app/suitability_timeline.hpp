#pragma once

#include "vigia/mission/setup.hpp"
#include "vigia/report/replay_page.hpp"

namespace vigia::app {

/// The suitability, by the fuzzy planner's first supervisor, of each landmark that the robot could
/// have looked at from where its driving localizer believed to be, at most kSuitability_hz times a
/// second, more seldom on a long drive among many landmarks. For a robot whose head directs a
/// camera. Made of the recorded beliefs once the drive is over, which it therefore does not slow.
report::ReplaySuitability suitability(const mission::MissionSetup& setup,
                                      const report::ReplayRun& run);

inline constexpr double kSuitability_hz = 5.0;

}  // namespace vigia::app
