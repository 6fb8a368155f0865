#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpRGBa.h>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {

/// What a pixel of a field of play shows, by its colour.
enum class FieldClass : std::uint8_t { other, green, white, yellow, blue, black };
constexpr std::size_t kFieldClasses = 6;
std::string_view to_string(FieldClass of);

/// The colours of a class that has a hue: hue within half_width of the middle, and no paler and no
/// darker than this. Saturation is 1 − min/max of the channels, value their maximum.
struct HueRange {
  double hue = 0.0;         ///< rad: red 0, green 2π/3, blue 4π/3
  double half_width = 0.5;  ///< rad
  double min_saturation = 0.3;
  double min_value = 40.0;  ///< grey levels
};

/// The colours of a field under one light.
struct FieldColours {
  HueRange green{from_deg(125.0), from_deg(48.0), 0.22, 40.0};
  HueRange yellow{from_deg(53.0), from_deg(17.0), 0.40, 70.0};
  HueRange blue{from_deg(217.0), from_deg(30.0), 0.45, 60.0};
  double white_max_saturation = 0.22;
  double white_min_value = 110.0;                      ///< grey levels
  double black_max_value = 45.0;                       ///< grey levels
  Eigen::Vector3d green_mean = {60.0, 150.0, 70.0};    ///< of the carpet, R G B levels
  Eigen::Vector3d white_mean = {210.0, 215.0, 210.0};  ///< of the lines, R G B levels
};

/// Tells the classes of pixels by a table over colours. Without colours of its own it has wide
/// ranges that hold the fields that cameras see under most lamps.
class FieldPalette {
 public:
  explicit FieldPalette(const FieldColours& colours = {});

  FieldClass operator()(const vpRGBa& pixel) const {
    return table_[(static_cast<std::size_t>(pixel.R >> kDropped) << (2 * kBits)) |
                  (static_cast<std::size_t>(pixel.G >> kDropped) << kBits) |
                  static_cast<std::size_t>(pixel.B >> kDropped)];
  }
  const FieldColours& colours() const { return colours_; }

 private:
  static constexpr int kBits = 5;  ///< of each channel
  static constexpr int kDropped = 8 - kBits;
  FieldColours colours_;
  std::array<FieldClass, (1U << (3 * kBits))> table_{};
};

}  // namespace vigia::tracking
