#include "vigia/sim/wheel_slip.hpp"

#include <cmath>
#include <limits>

namespace vigia::sim {

WheelSlip::WheelSlip(const WheelSlipParams& params, std::uint64_t seed)
    : params_(params), random_(seed, "wheel slip") {
  diameter_ = params_.diameter * random_.normal();
  base_ = params_.base * random_.normal();
  gap_left_m_ = draw_gap();
}

double WheelSlip::draw_gap() {
  if (params_.per_m <= 0.0) return std::numeric_limits<double>::infinity();
  return -std::log(1.0 - random_.uniform(0.0, 1.0)) / params_.per_m;
}

void WheelSlip::begin_slip() {
  slip_left_m_ = random_.uniform(params_.min_m, params_.max_m);
  loss_ = random_.uniform(params_.min_loss, params_.max_loss);
  skew_per_m_ = params_.skew_per_m * random_.normal();
  gap_left_m_ = draw_gap();
}

ArcMotion WheelSlip::over_ground(const ArcMotion& wheels) {
  ArcMotion ground{wheels.distance * (1.0 + diameter_), wheels.turn * (1.0 + base_),
                   wheels.side * (1.0 + diameter_)};
  const double driven = std::hypot(wheels.distance, wheels.side);
  if (slipping()) {
    ground.distance *= 1.0 - loss_;
    ground.side *= 1.0 - loss_;
    ground.turn += skew_per_m_ * driven;
    slip_left_m_ -= driven;
  } else {
    gap_left_m_ -= driven;
    if (gap_left_m_ <= 0.0) begin_slip();
  }
  return ground;
}

}  // namespace vigia::sim
