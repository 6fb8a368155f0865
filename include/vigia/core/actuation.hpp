#pragma once

#include "vigia/core/angle.hpp"
#include "vigia/core/head.hpp"

namespace vigia {

/// Speed of the base: forward (m/s), counter-clockwise turn (rad/s) and, of an omnidirectional one,
/// to the left (m/s).
struct BaseRates {
  double v = 0.0;
  double w = 0.0;
  double vy = 0.0;
};

/// Rates of the head and the zoom.
struct HeadRates {
  HeadAngles angles;       ///< rad/s
  double zoom_mm_s = 0.0;  ///< mm/s of nominal focal length
};

/// What base, head and zoom can do. Each axis is limited by itself.
struct BaseLimits {
  double speed = 0.3;              ///< m/s
  double acceleration = 0.5;       ///< m/s²
  double turn_rate = 0.8;          ///< rad/s
  double turn_acceleration = 2.0;  ///< rad/s²
  double side_speed = 0.0;         ///< m/s; 0: a unicycle
  double side_acceleration = 0.5;  ///< m/s²

  bool omnidirectional() const { return side_speed > 0.0; }
};

struct HeadLimits {
  double pan_min = -kPi;
  double pan_max = kPi;
  double tilt_min = -0.5 * kPi;
  double tilt_max = 0.5 * kPi;
  double rate = 1.5;            ///< rad/s, pan and tilt
  double acceleration = 8.0;    ///< rad/s²
  double zoom_rate_mm_s = 8.0;  ///< the slowest axis: 5 s from end to end
};

/// What the head reports: encoder angles, zoom position, and the rates it runs at.
struct HeadReading {
  HeadAngles angles;
  HeadAngles rates;
  double zoom_mm = 8.0;
};

}  // namespace vigia
