#include "vigia/tracking/ellipse_tracker.hpp"

#include "vigia/tracking/correlation_tracker.hpp"
#include "vigia/tracking/disc_tracker.hpp"
#include "vigia/tracking/moving_edge_tracker.hpp"

namespace vigia::tracking {

std::unique_ptr<EllipseTracker> make_ellipse_tracker(const std::string& name) {
  if (name == "disc") return std::make_unique<DiscTracker>();
  if (name == "ellipse") return std::make_unique<MovingEdgeTracker>();
  if (name == "correlation") return std::make_unique<CorrelationTracker>();
  return nullptr;
}

}  // namespace vigia::tracking
