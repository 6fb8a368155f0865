#pragma once

#include "vigia/localization/landmark_information.hpp"
#include "vigia/mission/setup.hpp"
#include "vigia/planner/head_model.hpp"
#include "vigia/planner/visibility.hpp"

namespace vigia::mission {

// What plans of perception are made from, as a mission has it. For a robot whose head directs a
// camera: std::logic_error.

planner::Visibility visibility(const MissionSetup& setup);
planner::HeadModel head_model(const MissionSetup& setup);
localization::LandmarkInformation landmark_information(const MissionSetup& setup);

}  // namespace vigia::mission
