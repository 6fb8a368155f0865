#pragma once

#include "vigia/localization/ekf_state.hpp"
#include "vigia/localization/localizer.hpp"

namespace vigia::localization {

/// What the gate weighs points with.
struct PointsGate {
  const RigOnGround& on_ground;
  const SensorNoise& noise;
  double probability;  ///< share of right measurements that pass each of the two tests
};

/// Whether the points of a known landmark are where the state expects them. The state is first
/// moved to the most likely one given both (iterated update: near a landmark the first
/// linearisation is not enough). Two tests there: the innovation of what the points say about the
/// state (its NIS is the result's), and the scatter of the points about it, 2N − 6 degrees of
/// freedom. @p state carries the biases of the fix's look.
UpdateResult gate_points(const PointsGate& gate, const EkfState& state, const PointsFix& fix);

}  // namespace vigia::localization
