#include "vigia/evaluation/rendered_views.hpp"

#include <algorithm>

#include "vigia/core/world_map.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::evaluation {
namespace {

/// Of several patterns in the picture the one that is asked for, or else any.
const tracking::PointsFeature* pick(const std::vector<tracking::PointsFeature>& features,
                                    LandmarkId wanted) {
  const tracking::PointsFeature* other = nullptr;
  for (const auto& feature : features) {
    if (feature.status != tracking::FeatureStatus::found || !feature.landmark) continue;
    if (*feature.landmark == wanted) return &feature;
    other = &feature;
  }
  return other;
}

}  // namespace

RenderedViews render_views(const QuixoteSetting& setting, const std::vector<PatternView>& views,
                           const sim::ImagingParams& imaging, std::uint64_t seed) {
  const WorldMap world{"quixote", quixote_room(setting), {}, quixote_patterns(setting)};
  const sim::Scene scene(world, std::make_shared<const sim::Appearance>(), seed);
  const auto tracker = tracking::make_point_tracker("pattern", {false, world.landmarks});
  RenderedViews result;
  std::int64_t picture = 0;
  for (const PatternView& view : views) {
    const auto frame = scene.expose(view.wMc, setting.camera, Stamp{picture++}, imaging);
    const auto features = tracker->find_all(*frame);
    const auto* feature = pick(features, view.landmark.id);
    if (feature == nullptr) {
      ++result.rejected;
    } else if (*feature->landmark != view.landmark.id) {
      ++result.wrong;
    } else {
      PatternView read = view;
      read.seen.points = feature->points;
      result.read.push_back(read);
    }
  }
  return result;
}

}  // namespace vigia::evaluation
