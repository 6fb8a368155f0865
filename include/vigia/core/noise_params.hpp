#pragma once

#include "vigia/core/noise_model.hpp"
#include "vigia/core/params.hpp"

namespace vigia {

// The keys of the noise of a robot's sensors (see ParamVisitor).
void describe(ParamVisitor& v, OdometryNoise& p);
void describe(ParamVisitor& v, SensorNoise& p);
void describe(ParamVisitor& v, StereoCalibrationNoise& p);
/// The odometry's and the sensors' noise that the caller has set are the default: the robot's.
void describe(ParamVisitor& v, NoiseModel& p);

}  // namespace vigia
