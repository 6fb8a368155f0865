#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/stamp.hpp"
#include "vigia/sim/disturbances.hpp"

namespace vigia::sim {

/// The gain of the light at one instant: ambient + Σ lamps strength / (1 + |p − p_k|² / width²).
struct LightNow {
  struct Lamp {
    Eigen::Vector3d p_w = Eigen::Vector3d::Zero();
    double strength = 0.0;
  };
  double ambient = 1.0;
  double width_m = 3.0;
  std::array<Lamp, 4> lamps;

  double gain(const Eigen::Vector3d& p_w) const;
};

/// Four lamps of unequal strength under the ceiling. With all of them on, the gain runs from
/// 1 − room to 1 + room over the room; the whole drifts slowly, and lamps lose or regain light at
/// random times.
class LightField {
 public:
  LightField(const LightParams& params, const FloorPlan& plan, std::uint64_t seed,
             const Ground& ground = {});

  LightNow at(Stamp stamp) const;
  /// When lamps step, in order, as far as an hour.
  std::vector<Stamp> steps() const;

 private:
  struct Step {
    Stamp stamp;
    std::size_t lamp;
    double level;
  };

  LightParams params_;
  LightNow full_;
  std::array<double, 3> phases_{};
  std::vector<Step> steps_;
};

}  // namespace vigia::sim
