#pragma once

#include <cmath>

namespace vigia {

inline constexpr double kPi = 3.14159265358979323846;

/// Degrees to radians.
constexpr double from_deg(double degrees) {
  return degrees * (kPi / 180.0);
}
/// Radians to degrees.
constexpr double to_deg(double radians) {
  return radians * (180.0 / kPi);
}

/// The same angle in (-π, π]. The one place where angles are wrapped.
inline double wrap_angle(double radians) {
  const double wrapped = std::remainder(radians, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace vigia
