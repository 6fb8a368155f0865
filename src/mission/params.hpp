#pragma once

#include "vigia/core/params.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::mission {

// The keys of the mission's own parameters (see ParamVisitor).
void describe(ParamVisitor& v, LookParams& p);
void describe(ParamVisitor& v, RecoveryParams& p);
void describe(ParamVisitor& v, MissionSetup& setup);

}  // namespace vigia::mission
