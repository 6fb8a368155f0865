#pragma once

#include "vigia/core/odometry.hpp"
#include "vigia/core/params.hpp"
#include "vigia/core/sensor_noise.hpp"

namespace vigia {

// The keys of the noise of a robot's sensors (see ParamVisitor).
void describe(ParamVisitor& v, OdometryNoise& p);
void describe(ParamVisitor& v, SensorNoise& p);

}  // namespace vigia
