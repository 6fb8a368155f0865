#include "vigia/servo/base_motion.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::servo {
namespace {

struct Foreseen {
  double mean;
  double end;
};

/// A rate that goes from @p rate to @p command at constant acceleration and then stays.
Foreseen ramp(double rate, double command, double acceleration, double tick) {
  const double change = command - rate;
  const double ramp_time = std::min(tick, std::abs(change) / acceleration);
  const double end = rate + std::copysign(acceleration * ramp_time, change);
  return {(0.5 * (rate + end) * ramp_time + end * (tick - ramp_time)) / tick, end};
}

}  // namespace

BaseRates BaseMotion::expect(const BaseRates& odometry, const BaseRates& command) {
  const BaseLimits& limits = params_.limits;
  offset_.v += params_.adaptation * (odometry.v - mean_.v);
  offset_.w += params_.adaptation * (odometry.w - mean_.w);
  offset_.vy += params_.adaptation * (odometry.vy - mean_.vy);
  const Foreseen forward = ramp(end_.v, std::clamp(command.v, -limits.speed, limits.speed),
                                limits.acceleration, params_.tick_s);
  const Foreseen turn = ramp(end_.w, std::clamp(command.w, -limits.turn_rate, limits.turn_rate),
                             limits.turn_acceleration, params_.tick_s);
  const Foreseen side = ramp(end_.vy, std::clamp(command.vy, -limits.side_speed, limits.side_speed),
                             limits.side_acceleration, params_.tick_s);
  end_ = {forward.end, turn.end, side.end};
  mean_ = {forward.mean + offset_.v, turn.mean + offset_.w, side.mean + offset_.vy};
  return mean_;
}

}  // namespace vigia::servo
