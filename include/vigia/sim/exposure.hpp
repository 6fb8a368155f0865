#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "vigia/sim/body.hpp"
#include "vigia/sim/light_field.hpp"

namespace vigia::sim {

/// What the camera may see that is no part of the building, and from where, while the shutter is
/// open.
struct Exposure {
  struct Instant {
    Eigen::Isometry3d wMc = Eigen::Isometry3d::Identity();
    std::vector<Person> people;
  };
  /// Spread evenly over the exposure; the picture is their mean. One: nothing moves.
  std::vector<Instant> instants;
  std::optional<LightNow> light;  ///< even and 1 without it
};

}  // namespace vigia::sim
