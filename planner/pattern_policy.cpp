#include "pattern_policy.hpp"

#include <algorithm>

namespace vigia::planner {
namespace {

bool failed_lately(const LookContext& context, LandmarkId id) {
  return std::find(context.excluded.begin(), context.excluded.end(), id) != context.excluded.end();
}

}  // namespace

std::optional<LandmarkId> PatternPolicy::choose(const LookContext& context) {
  const Pose2& pose = context.belief.pose;
  std::optional<LandmarkId> best;
  double nearest = 0.0;
  for (const Landmark& landmark : context.landmarks.all()) {
    const bool occluded = failed_lately(context, landmark.id);
    if (occluded || disc_radius(landmark)) continue;
    if (context.visibility.sight(landmark, pose) != Sight::visible) continue;
    if (context.visibility.view_angle(landmark, pose) < min_view_angle_) continue;
    const double range = context.visibility.range(landmark, pose);
    if (best && range >= nearest) continue;
    best = landmark.id;
    nearest = range;
  }
  return best;
}

}  // namespace vigia::planner
