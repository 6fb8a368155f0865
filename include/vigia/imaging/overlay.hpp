#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/observation.hpp"

namespace vigia::imaging {

/// What is drawn over a camera frame. Pixels as everywhere: integer = pixel centre.
struct Overlay {
  std::optional<Ellipse> predicted = {};                ///< dashed, orange
  std::optional<Ellipse> measured = {};                 ///< solid, sky blue, with its centre
  std::vector<Eigen::Vector2d> points = {};             ///< measured: small sky-blue crosses
  std::optional<Eigen::Vector2d> principal_point = {};  ///< a cross
  std::vector<std::string> lines = {};                  ///< UTF-8, top left, one below the other
};

}  // namespace vigia::imaging
