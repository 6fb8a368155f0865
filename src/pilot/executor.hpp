#pragma once

#include <vector>

#include <Eigen/Core>

#include "vigia/core/actuation.hpp"
#include "vigia/pilot/pilot_params.hpp"

namespace vigia::pilot {

/// A point in the base frame that the base must not touch.
struct Hazard {
  Eigen::Vector2d p_r;
  bool known = false;  ///< part of the floor plan, which the path keeps clear of
};

/// Turns a fused command into rates that the base may run at: within its limits, and never faster
/// than it can stop before the hazards on the arc that it would drive.
class Executor {
 public:
  Executor(double robot_radius_m, BaseLimits limits, AvoidanceParams params)
      : robot_radius_m_(robot_radius_m), limits_(limits), params_(params) {}

  /// @p beside_m must stay free beside the robot.
  BaseRates execute(const BaseRates& wanted, const std::vector<Hazard>& hazards,
                    double beside_m = 0.025) const;

 private:
  double stopping_speed(const BaseRates& wanted, const Hazard& hazard, double beside_m) const;

  double robot_radius_m_;
  BaseLimits limits_;
  AvoidanceParams params_;
};

}  // namespace vigia::pilot
