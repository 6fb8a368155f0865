#include "vigia/tracking/ellipse_tracker.hpp"

#include "vigia/tracking/correlation_tracker.hpp"
#include "vigia/tracking/disc_tracker.hpp"
#include "vigia/tracking/moving_edge_tracker.hpp"

namespace vigia::tracking {

std::string_view to_string(FeatureStatus status) {
  switch (status) {
    case FeatureStatus::found:
      return "found";
    case FeatureStatus::not_found:
      return "not_found";
    case FeatureStatus::occluded:
      return "occluded";
    case FeatureStatus::cut_by_border:
      return "cut_by_border";
    case FeatureStatus::wrong_object:
      return "wrong_object";
    case FeatureStatus::low_contrast:
      return "low_contrast";
  }
  return "unknown";
}

std::unique_ptr<EllipseTracker> make_ellipse_tracker(const std::string& name) {
  if (name == "disc") return std::make_unique<DiscTracker>();
  if (name == "ellipse") return std::make_unique<MovingEdgeTracker>();
  if (name == "correlation") return std::make_unique<CorrelationTracker>();
  return nullptr;
}

}  // namespace vigia::tracking
