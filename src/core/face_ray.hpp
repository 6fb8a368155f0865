#pragma once

#include <Eigen/Core>

#include "vigia/core/floor_plan.hpp"

namespace vigia {

/// Distance along the ray to a face, or infinity. A face seen edge-on is met at its near end.
double ray_distance(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                    const Wall& face);

}  // namespace vigia
