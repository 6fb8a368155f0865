#pragma once

#include "vigia/pilot/pilot.hpp"

namespace vigia::pilot {

/// What the fusion supervisor is told.
struct Situation {
  bool hold = false;      ///< ordered to stand still
  double ahead_m = 0.0;   ///< along the path to where something is in the way; infinite if nothing
  double lasted_s = 0.0;  ///< for how long the path has been blocked
  bool evading = false;   ///< a way round is being driven
  bool way_round = false;
};

/// How much each behaviour has to say: rules with smooth memberships, product for "and".
///
///   avoid:  (evading or the blockade has lasted) and there is a way round
///   hold:   ordered; or not avoid and (the blockade is near or, while evading, no way is left)
///   follow: what the others leave
Activations supervise(const Situation& situation, const AvoidanceParams& params);

}  // namespace vigia::pilot
