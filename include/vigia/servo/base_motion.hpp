#pragma once

#include "vigia/core/actuation.hpp"

namespace vigia::servo {

struct BaseMotionParams {
  BaseLimits limits;
  double tick_s = 0.04;       ///< a command holds this long
  double adaptation = 0.005;  ///< share of odometry's disagreement that is taken over per tick
};

/// What the base is about to do. Odometry's rates are noisy from tick to tick and one tick late: at
/// f = 700 px that costs two pixels of centring. The base follows its commands within its limits,
/// so the next tick's rates are those foreseen from the command, plus what odometry says, averaged
/// over many ticks, that the base does otherwise.
class BaseMotion {
 public:
  explicit BaseMotion(BaseMotionParams params) : params_(params) {}

  /// The mean rates over the coming tick. @p odometry: mean rates of the past tick; @p command:
  /// what the base is asked for in the coming one.
  BaseRates expect(const BaseRates& odometry, const BaseRates& command);

 private:
  BaseMotionParams params_;
  BaseRates end_;   ///< foreseen for the end of the tick that was foreseen last, without the offset
  BaseRates mean_;  ///< foreseen mean of that tick
  BaseRates offset_;  ///< of the base against its commands
};

}  // namespace vigia::servo
