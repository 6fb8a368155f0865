#pragma once

#include <vector>

#include "vigia/core/stamp.hpp"

namespace vigia {

/// One beam of a ring of range sensors.
struct RangeReading {
  double bearing = 0.0;  ///< rad, of the beam in the base frame, counter-clockwise from x
  double range_m = 0.0;  ///< from the base's centre to the echo; the sensor's reach when none came
  bool echo = false;     ///< whether anything answered within the sensor's reach
};

/// What the whole ring says at one instant. Readings, not the truth.
struct RangeScan {
  Stamp stamp;
  double reach_m = 0.0;  ///< beyond this a beam sees nothing
  std::vector<RangeReading> readings;
};

}  // namespace vigia
