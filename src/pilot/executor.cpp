#include "executor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vigia/core/odometry.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/pilot/pursuit.hpp"

namespace vigia::pilot {
namespace {

constexpr double kStride = 0.04;  // m between two places on the arc that are tried

/// The place of a base that has driven @p distance on an arc, from where it is now.
Eigen::Vector2d along(double curvature, double distance) {
  const double half = 0.5 * curvature * distance;
  const double chord = std::abs(half) < 1e-6 ? distance : distance * std::sin(half) / half;
  return chord * unit_vector(half);
}

}  // namespace

double Executor::stopping_speed(const BaseRates& wanted, const Hazard& hazard,
                                double beside_m) const {
  const double keep = hazard.known ? params_.brake_known_m : params_.brake_m;
  // How far the base might still roll, and what it leaves before the hazard.
  const double roll = wanted.v * wanted.v / (1.4 * limits_.acceleration) + keep + kStride;
  const double contact = robot_radius_m_ + beside_m;
  const double here = hazard.p_r.norm();
  if (here > contact + roll) return std::numeric_limits<double>::infinity();
  const double curvature = wanted.w / std::max(wanted.v, 1e-3);
  for (double driven = 0.5 * kStride; driven <= roll; driven += kStride) {
    const double there = (hazard.p_r - along(curvature, driven)).norm();
    if (there < contact && there < here)
      return braking_rate(limits_.acceleration, driven - 0.5 * kStride - keep);
  }
  return std::numeric_limits<double>::infinity();
}

BaseRates Executor::execute(const BaseRates& wanted, const std::vector<Hazard>& hazards,
                            double beside_m) const {
  BaseRates rates{std::clamp(wanted.v, 0.0, limits_.speed),
                  std::clamp(wanted.w, -limits_.turn_rate, limits_.turn_rate)};
  if (rates.v <= 0.0) return rates;
  double speed = rates.v;
  for (const Hazard& hazard : hazards)
    speed = std::min(speed, stopping_speed(rates, hazard, beside_m));
  rates.v = speed;
  return rates;
}

}  // namespace vigia::pilot
