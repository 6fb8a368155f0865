#pragma once

#include "vigia/sim/robot.hpp"

namespace vigia::sim::testing {

/// A robot whose odometry, encoders and zoom have no errors.
inline RobotParams exact_robot() {
  RobotParams params;
  params.odometry = {0.0, 0.0, 0.0};
  params.sensor = {0.0, 0.0, 0.0};
  return params;
}

}  // namespace vigia::sim::testing
