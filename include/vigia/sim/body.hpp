#pragma once

#include <vector>

#include <Eigen/Core>

namespace vigia::sim {

/// What somebody looks like.
enum class Figure {
  person,
  coloured_person,  ///< in bright clothes
  robot,            ///< a dark one with a marker in its team's colour, cyan or magenta
  chassis,          ///< what a robot's own cameras see of it
};

/// Somebody who stands or walks upright on the floor.
struct Person {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  double heading = 0.0;    ///< where he faces, rad
  double radius_m = 0.25;  ///< the body lies within it
  double height_m = 1.75;
  double walked_m = 0.0;  ///< so far: where in the stride he is
  bool walking = false;
  int look = 0;  ///< which clothes, which team
  Figure figure = Figure::person;
  double floor_m = 0.0;  ///< height of what he stands on
};

}  // namespace vigia::sim
