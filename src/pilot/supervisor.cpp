#include "supervisor.hpp"

#include <algorithm>

namespace vigia::pilot {
namespace {

/// Rises smoothly from 0 at @p low to 1 at @p high.
double rising(double x, double low, double high) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

Activations supervise(const Situation& situation, const AvoidanceParams& params) {
  if (situation.hold) return {0.0, 0.0, 1.0};
  const double near = 1.0 - rising(situation.ahead_m, params.near_m, params.notice_m);
  const double lasting = rising(situation.lasted_s, 0.5 * params.patience_s, params.patience_s);
  Activations activations;
  if (situation.detour_exists) activations.avoid = situation.evading ? 1.0 : lasting;
  const bool detour_lost = situation.evading && !situation.detour_exists;
  activations.hold = (1.0 - activations.avoid) * (detour_lost ? 1.0 : near);
  activations.follow = 1.0 - activations.avoid - activations.hold;
  return activations;
}

}  // namespace vigia::pilot
