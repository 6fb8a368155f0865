#pragma once

#include "vigia/core/config.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::mission {

// Each reads one map of a mission file into its parameter struct, whose values are the defaults.
// All throw InputError.
void read_ekf(MapReader reader, const sim::RobotParams& robot, localization::EkfParams& params);
void read_perception(MapReader& look, LookParams& params);
void read_look(MapReader& reader, LookParams& params);
void read_gaze(MapReader reader, servo::GazeParams& params);
void read_pilot(MapReader reader, const sim::RobotSetup& robot, pilot::PilotParams& params);
void read_recovery(MapReader reader, RecoveryParams& params);

}  // namespace vigia::mission
