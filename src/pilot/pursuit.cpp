#include "vigia/pilot/pursuit.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::pilot {
namespace {

constexpr double kAligned = from_deg(4);  // heading error at which a turn on the spot ends
constexpr double kTurnGain = 3.0;         // 1/s, of the turn's final approach
constexpr double kShare = 0.7;            // of the acceleration that braking counts on

}  // namespace

double braking_rate(double acceleration, double distance) {
  return std::sqrt(2.0 * kShare * acceleration * std::max(distance, 0.0));
}

BaseRates Pursuit::turn(double error) const {
  const double rate = std::min({limits_.turn_rate, kTurnGain * std::abs(error),
                                braking_rate(limits_.turn_acceleration, std::abs(error))});
  return {0.0, std::copysign(rate, error)};
}

BaseRates Pursuit::step(const Eigen::Vector2d& target_r, double speed) {
  const double error = std::atan2(target_r.y(), target_r.x());
  if (std::abs(error) > aside_) turning_ = true;
  if (std::abs(error) < kAligned) turning_ = false;
  if (turning_) return turn(error);

  // The arc through the target has the curvature 2y/L².
  const double curvature = 2.0 * target_r.y() / std::max(target_r.squaredNorm(), 1e-4);
  double v = speed;
  if (std::abs(curvature) * v > limits_.turn_rate) v = limits_.turn_rate / std::abs(curvature);
  return {v, v * curvature};
}

}  // namespace vigia::pilot
