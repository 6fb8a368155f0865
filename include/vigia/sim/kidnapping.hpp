#pragma once

#include <cstdint>
#include <optional>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/random.hpp"
#include "vigia/core/stamp.hpp"
#include "vigia/sim/disturbances.hpp"
#include "vigia/sim/walkers.hpp"

namespace vigia::sim {

/// When the robot is put elsewhere, and where to.
class Kidnapping {
 public:
  Kidnapping(const KidnappingParams& params, std::uint64_t seed);

  /// Where to put a robot of that radius that stands at @p from: once, when @p now has come to the
  /// time; in a place as free as the building and the @p people in it allow.
  std::optional<Pose2> due(Stamp now, const Pose2& from, double radius_m, const FloorPlan& plan,
                           const Walkers* people = nullptr);

 private:
  KidnappingParams params_;
  RandomStream random_;
  Stamp when_;
  bool done_ = false;
};

}  // namespace vigia::sim
