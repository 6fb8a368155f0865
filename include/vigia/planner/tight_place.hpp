#pragma once

#include <Eigen/Core>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/path.hpp"

namespace vigia::planner {

/// A place where a path leaves the robot little room.
struct TightPlace {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double station_m = 0.0;
  double beside_m = 0.0;  ///< between the robot's edge and the nearest face; infinite without any
};

/// The tightest of those that are @p ends_m away from both ends of the path.
TightPlace tightest_place(const FloorPlan& plan, const Path& path, double robot_radius_m,
                          double ends_m = 0.0);

}  // namespace vigia::planner
