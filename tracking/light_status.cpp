#include "light_status.hpp"

#include "hue.hpp"

#include <cmath>

namespace vigia::tracking {

LightStatus light_status(const FieldPalette& palette, const RadialScan& scan) {
  constexpr double kLeastGreen = 0.08;  // of the pixels of the rays
  constexpr double kMostBlack = 0.6;
  constexpr double kRim = 0.8;      // of the hue's half width
  constexpr double kPaleRim = 1.1;  // of the least saturation
  const auto share = [&](FieldClass of) { return scan.shares[static_cast<std::size_t>(of)]; };
  if (share(FieldClass::green) < kLeastGreen)
    return share(FieldClass::black) > kMostBlack ? LightStatus::too_dark : LightStatus::no_green;
  const HueRange& green = palette.colours().green;
  const HueColour mean = hue_colour(scan.green_mean);
  const bool inside = std::abs(wrap_angle(mean.hue - green.hue)) <= kRim * green.half_width &&
                      mean.saturation >= kPaleRim * green.min_saturation;
  return inside ? LightStatus::in_range : LightStatus::off_colour;
}

std::string_view to_string(LightStatus status) {
  switch (status) {
    case LightStatus::in_range:
      return "in_range";
    case LightStatus::too_dark:
      return "too_dark";
    case LightStatus::no_green:
      return "no_green";
    case LightStatus::off_colour:
      return "off_colour";
  }
  return "in_range";
}

}  // namespace vigia::tracking
