#include "pattern_policy.hpp"

namespace vigia::planner {

std::optional<LookChoice> PatternPolicy::choose(const LookContext& context) {
  const Pose2& pose = context.belief.pose;
  std::optional<LookChoice> best;
  double nearest = 0.0;
  for (const Landmark& landmark : context.landmarks.all()) {
    if (disc_radius(landmark) || !can_be_observed(landmark, context, pose)) continue;
    if (context.visibility.view_angle(landmark, pose) < min_view_angle_) continue;
    const double range = context.visibility.range(landmark, pose);
    if (best && range >= nearest) continue;
    best = LookChoice{landmark.id, {}, {}, "the nearest pattern that is not seen frontally"};
    nearest = range;
  }
  return best;
}

}  // namespace vigia::planner
