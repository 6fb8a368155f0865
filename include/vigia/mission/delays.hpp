#pragma once

#include "vigia/core/rig.hpp"
#include "vigia/core/stamp.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::mission {

/// From an exposure of @p camera to the tick in which its image is observed, at most: the camera's
/// latency, that of `disturbances.latency` and its processing, and the wait for an image before it
/// to be processed.
Duration longest_delay(const MissionSetup& setup, const Camera& camera);

/// … of all the robot's cameras.
Duration longest_delay(const MissionSetup& setup);

}  // namespace vigia::mission
