#pragma once

#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/localization/disc_model.hpp"

namespace vigia::evaluation {

/// The landmark that an observation truly shows, seen from the true pose at the exposure with the
/// true errors of the look's readings: the one that it names, or of the discs the one whose centre
/// lies nearest to the ellipse's and inside it. nullptr when it shows none of the map.
const Landmark* true_landmark(const Observation& observation, const LandmarkMap& map,
                              const RigOnGround& on_ground, const Pose2& truth,
                              const localization::LookBias& bias);

}  // namespace vigia::evaluation
