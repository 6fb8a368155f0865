#pragma once

#include <memory>
#include <string>

#include "vigia/localization/landmark_information.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/localization/pattern_fix.hpp"
#include "vigia/localization/relocalizer.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::mission {

// What localization is made from, as a mission has it.

localization::PatternFixParams pattern_fix_params(const MissionSetup& setup);
localization::RelocalizerParams relocalizer_params(const MissionSetup& setup);
localization::LandmarkInformation landmark_information(const MissionSetup& setup);

}  // namespace vigia::mission
