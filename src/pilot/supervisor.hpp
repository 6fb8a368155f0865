#pragma once

#include "vigia/pilot/pilot.hpp"

namespace vigia::pilot {

/// What the fusion supervisor judges by.
struct Situation {
  bool hold = false;      ///< ordered to stand still
  double ahead_m = 0.0;   ///< along the path to where something blocks it; infinite if nothing
  double lasted_s = 0.0;  ///< for how long the path has been blocked
  bool evading = false;   ///< a detour is being driven
  bool detour_exists = false;
};

/// How much each behaviour has to say: rules with smooth memberships, product for "and".
///
///   avoid:  (evading or the blockade has lasted) and there is a detour
///   hold:   ordered; or not avoid and (the blockade is near or, while evading, no detour is left)
///   follow: what the others leave
Activations supervise(const Situation& situation, const AvoidanceParams& params);

}  // namespace vigia::pilot
