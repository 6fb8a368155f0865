#pragma once

#include "vigia/core/params.hpp"
#include "vigia/pilot/pilot_params.hpp"

namespace vigia::pilot {

// The keys of the pilot's parameters (see ParamVisitor).
void describe(ParamVisitor& v, PathFollowerParams& p);
/// σ as the caller has set it is the default: the robot's.
void describe(ParamVisitor& v, RingParams& p);
void describe(ParamVisitor& v, AvoidanceParams& p);

}  // namespace vigia::pilot
