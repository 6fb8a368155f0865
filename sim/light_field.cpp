#include "vigia/sim/light_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

constexpr double kLast_s = 3600.0;

}  // namespace

double LightNow::gain(const Eigen::Vector3d& p_w) const {
  double gain = ambient;
  for (const Lamp& lamp : lamps)
    gain += lamp.strength / (1.0 + (p_w - lamp.p_w).squaredNorm() / (width_m * width_m));
  return gain;
}

LightField::LightField(const LightParams& params, const FloorPlan& plan, std::uint64_t seed,
                       const Ground& ground)
    : params_(params) {
  RandomStream random(seed, "light");
  const Eigen::Vector2d low = plan.min_corner();
  const Eigen::Vector2d size = plan.max_corner() - low;
  full_.ambient = 0.0;
  full_.width_m = std::max(1.0, 0.3 * size.minCoeff());
  for (std::size_t i = 0; i < full_.lamps.size(); ++i) {
    const std::size_t column = i % 2;
    const std::size_t row = i / 2;
    const double x = 0.25 + 0.5 * static_cast<double>(column) + random.uniform(-0.1, 0.1);
    const double y = 0.25 + 0.5 * static_cast<double>(row) + random.uniform(-0.1, 0.1);
    full_.lamps[i] = {
        ground.lift({low.x() + x * size.x(), low.y() + y * size.y()}, plan.ceiling_m()),
        random.uniform(0.6, 1.4)};
  }
  double dimmest = std::numeric_limits<double>::infinity();
  double brightest = 0.0;
  constexpr int kGrid = 24;
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; j <= kGrid; ++j) {
      for (const double height : {0.0, 0.5, 1.0}) {
        const Eigen::Vector2d at(low.x() + size.x() * i / kGrid, low.y() + size.y() * j / kGrid);
        const double gain = full_.gain(ground.lift(at, height * plan.ceiling_m()));
        dimmest = std::min(dimmest, gain);
        brightest = std::max(brightest, gain);
      }
    }
  }
  const double scale = 2.0 * params_.room / (brightest - dimmest);
  full_.ambient = 1.0 - 0.5 * scale * (dimmest + brightest);
  for (auto& lamp : full_.lamps) lamp.strength *= scale;

  for (double& phase : phases_) phase = random.uniform(-kPi, kPi);
  double t = 0.0;
  while (params_.step_every_s > 0.0) {
    t -= params_.step_every_s * std::log(1.0 - random.uniform(0.0, 1.0));
    if (t > kLast_s) break;
    const std::size_t lamp = random.index(full_.lamps.size());
    steps_.push_back({Stamp::from_seconds(t), lamp, 1.0 - random.uniform(0.0, params_.lamp_step)});
  }
}

LightNow LightField::at(Stamp stamp) const {
  LightNow now = full_;
  std::array<double, 4> level{1.0, 1.0, 1.0, 1.0};
  for (const Step& step : steps_) {
    if (step.stamp > stamp) break;
    level[step.lamp] = step.level;
  }
  // Three waves whose periods have no common multiple; their amplitudes add up to the drift.
  const double turns = 2.0 * kPi * stamp.seconds() / params_.drift_period_s;
  const double drift = 1.0 + params_.drift * (0.5 * std::sin(turns + phases_[0]) +
                                              0.3 * std::sin(1.618 * turns + phases_[1]) +
                                              0.2 * std::sin(2.414 * turns + phases_[2]));
  now.ambient *= drift;
  for (std::size_t i = 0; i < level.size(); ++i) now.lamps[i].strength *= drift * level[i];
  return now;
}

std::vector<Stamp> LightField::steps() const {
  std::vector<Stamp> stamps;
  stamps.reserve(steps_.size());
  for (const Step& step : steps_) stamps.push_back(step.stamp);
  return stamps;
}

}  // namespace vigia::sim
