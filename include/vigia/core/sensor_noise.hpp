#pragma once

#include "vigia/core/angle.hpp"

namespace vigia {

/// Error of the head's and the zoom's readings. Each look has one draw of the constant part, each
/// reading one of the white part: true = reading + look part + white part.
struct SensorNoise {
  double look_angle = from_deg(0.3);  ///< σ_b of pan and of tilt, rad, constant during a look
  double reading_angle = 0.0;         ///< σ_w of pan and of tilt, rad, white per reading
  double look_focal = 0.004;          ///< relative σ of the focal length, constant during a look
};

}  // namespace vigia
