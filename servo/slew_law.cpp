#include "vigia/servo/slew_law.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"

namespace vigia::servo {

double SlewLaw::rate_for(double error) const {
  const double distance = std::abs(error);
  // After this tick at v, what is left must suffice to stop: v² / 2a = distance − v·tick.
  const double stopping =
      acceleration * (std::sqrt(tick_s * tick_s + 2.0 * distance / acceleration) - tick_s);
  return std::copysign(std::min({rate, stopping, gain * distance}), error);
}

double slew_time(double distance, double rate, double acceleration) {
  const double d = std::abs(distance);
  const double ramps = rate * rate / acceleration;  // the distance of speeding up and slowing down
  return d <= ramps ? 2.0 * std::sqrt(d / acceleration) : d / rate + rate / acceleration;
}

HeadAngles spiral(double step, double elapsed_s) {
  constexpr double kPitchesPerSecond = 4.0;
  constexpr double kStart = kPi;
  // r = step φ / 2π has the arc length step φ² / 4π.
  const double phi = std::sqrt(kStart * kStart + 4.0 * kPi * kPitchesPerSecond * elapsed_s);
  const double r = step * phi / (2.0 * kPi);
  return {r * std::cos(phi), r * std::sin(phi)};
}

}  // namespace vigia::servo
