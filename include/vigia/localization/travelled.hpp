#pragma once

#include "vigia/core/odometry.hpp"
#include "vigia/localization/station_motion.hpp"

namespace vigia::localization {

/// Carries a motion in the robot's axes on by an increment of odometry and its errors.
void travel(StationMotion& motion, const OdometryIncrement& u, const OdometryNoise& noise);

}  // namespace vigia::localization
