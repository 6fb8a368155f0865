#pragma once

#include "vigia/localization/pattern_fix.hpp"
#include "vigia/localization/relocalizer.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::mission {

// What localization is made from, as a mission has it.

localization::PatternFixParams pattern_fix_params(const MissionSetup& setup);
localization::RelocalizerParams relocalizer_params(const MissionSetup& setup);

}  // namespace vigia::mission
