#pragma once

#include "vigia/core/params.hpp"
#include "vigia/servo/gaze_controller.hpp"

namespace vigia::servo {

// The keys of the servo's parameters (see ParamVisitor).
void describe(ParamVisitor& v, PanTiltServoParams& p);
void describe(ParamVisitor& v, ZoomControlParams& p);
void describe(ParamVisitor& v, GazeParams& p);

}  // namespace vigia::servo
