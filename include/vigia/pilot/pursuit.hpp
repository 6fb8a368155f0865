#pragma once

#include <Eigen/Core>

#include "vigia/core/actuation.hpp"

namespace vigia::pilot {

/// The largest rate from which an axis stops within @p distance, by a share of its acceleration.
double braking_rate(double acceleration, double distance);

/// Pure pursuit of a point, with a turn on the spot when it lies too far aside.
class Pursuit {
 public:
  /// @p turn_in_place rad: heading error above which the base turns on the spot.
  Pursuit(BaseLimits limits, double turn_in_place) : limits_(limits), aside_(turn_in_place) {}

  /// Turns on the spot until the next target lies ahead.
  void begin_turn() { turning_ = true; }
  /// The rates towards @p target_r (base frame) at a speed of at most @p speed.
  BaseRates step(const Eigen::Vector2d& target_r, double speed);

 private:
  BaseRates turn(double error) const;

  BaseLimits limits_;
  double aside_;
  bool turning_ = false;
};

}  // namespace vigia::pilot
