#pragma once

#include <Eigen/Core>

namespace vigia {

/// Something upright and round that stands where the floor plan has nothing.
struct RoundObstacle {
  Eigen::Vector2d centre;  ///< m, world frame
  double radius_m = 0.0;
};

}  // namespace vigia
