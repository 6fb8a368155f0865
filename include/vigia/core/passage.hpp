#pragma once

#include <vector>

#include <Eigen/Core>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/path.hpp"

namespace vigia {

/// A part of a path with faces near on both sides: a door, the gap between two tables, a corridor.
struct Passage {
  double begin_m = 0.0;  ///< stations between which a face is near on both sides
  double end_m = 0.0;
  double width_m = 0.0;                              ///< where it is narrowest
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< between the faces, there
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  ///< straight through, in the sense of travel
};

/// The passages of @p path in which the faces on both sides are less than 2 @p reach_m apart and
/// either of them is nearer than @p reach_m to the path. Those that follow within @p reach_m of
/// each other on one line are one.
std::vector<Passage> find_passages(const FloorPlan& plan, const Path& path, double reach_m);

}  // namespace vigia
