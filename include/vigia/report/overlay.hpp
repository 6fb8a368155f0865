#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/core/observation.hpp"

namespace vigia::report {

/// What is drawn over a camera frame. Pixels as everywhere: integer = pixel centre.
struct Overlay {
  std::optional<Ellipse> predicted = {};                ///< dashed, orange
  std::optional<Ellipse> measured = {};                 ///< solid, sky blue, with its centre
  std::vector<Eigen::Vector2d> points = {};             ///< measured: small sky-blue crosses
  std::optional<Eigen::Vector2d> principal_point = {};  ///< a cross
  std::vector<std::string> lines = {};                  ///< UTF-8, top left, one below the other
};

/// Draws the overlay on the image. Strokes and letters are outlined in black, so that they show on
/// any background; letters grow with the image. What lies outside the image or is not finite is
/// left out.
void draw_overlay(vpImage<vpRGBa>& image, const Overlay& overlay);

}  // namespace vigia::report
