#pragma once

#include <Eigen/Core>

namespace vigia::tracking {

/// A colour by hue (rad in [0, 2π)), saturation 1 − min/max and value max, grey levels.
struct HueColour {
  double hue = 0.0;
  double saturation = 0.0;
  double value = 0.0;
};

HueColour hue_colour(const Eigen::Vector3d& rgb);

}  // namespace vigia::tracking
