#include "vigia/tracking/field_palette.hpp"

#include "hue.hpp"

#include <cmath>

namespace vigia::tracking {
namespace {

bool in_hue_range(const HueRange& range, const HueColour& colour) {
  return std::abs(wrap_angle(colour.hue - range.hue)) <= range.half_width &&
         colour.saturation >= range.min_saturation && colour.value >= range.min_value;
}

FieldClass class_of(const FieldColours& colours, const Eigen::Vector3d& rgb) {
  const HueColour colour = hue_colour(rgb);
  if (colour.value <= colours.black_max_value) return FieldClass::black;
  // Saturated white-balanced hues first: a pale one may be white.
  if (in_hue_range(colours.green, colour)) return FieldClass::green;
  if (in_hue_range(colours.yellow, colour)) return FieldClass::yellow;
  if (in_hue_range(colours.blue, colour)) return FieldClass::blue;
  if (colour.saturation <= colours.white_max_saturation && colour.value >= colours.white_min_value)
    return FieldClass::white;
  return FieldClass::other;
}

}  // namespace

std::string_view to_string(FieldClass of) {
  switch (of) {
    case FieldClass::other:
      return "other";
    case FieldClass::green:
      return "green";
    case FieldClass::white:
      return "white";
    case FieldClass::yellow:
      return "yellow";
    case FieldClass::blue:
      return "blue";
    case FieldClass::black:
      return "black";
  }
  return "other";
}

FieldPalette::FieldPalette(const FieldColours& colours) : colours_(colours) {
  constexpr double kMiddle = 0.5 * ((1 << kDropped) - 1);  // of the colours in one entry
  constexpr std::size_t kMask = (1U << kBits) - 1;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const auto channel = [&](std::size_t index) {
      return static_cast<double>(((i >> (index * kBits)) & kMask) << kDropped) + kMiddle;
    };
    table_[i] = class_of(colours_, {channel(2), channel(1), channel(0)});
  }
}

}  // namespace vigia::tracking
