#pragma once

#include "vigia/core/head.hpp"

namespace vigia::servo {

/// The rate of one axis towards a goal at rest: as fast as it may go and still stop in time.
struct SlewLaw {
  double rate;          ///< rad/s
  double acceleration;  ///< rad/s²
  double gain;          ///< 1/s, of the final approach
  double tick_s;        ///< a command holds this long

  /// The rate to command when the goal is @p error away.
  double rate_for(double error) const;
};

/// Time from rest to rest over @p distance under limits of rate and acceleration.
double slew_time(double distance, double rate, double acceleration);

/// Where an Archimedean spiral of pitch @p step (rad) is @p elapsed_s after it began: it starts
/// half a turn out from the centre and runs four pitches a second.
HeadAngles spiral(double step, double elapsed_s);

}  // namespace vigia::servo
