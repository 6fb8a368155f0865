#include "vigia/tracking/point_tracker.hpp"

#include "vigia/tracking/pattern_tracker.hpp"
#include "vigia/tracking/tag_tracker.hpp"

namespace vigia::tracking {

std::unique_ptr<PointTracker> make_point_tracker(const std::string& name, const KnownCodes& known) {
  if (name == "pattern") return std::make_unique<PatternTracker>(known);
  if (name == "tag") return std::make_unique<TagTracker>(known);
  return nullptr;
}

}  // namespace vigia::tracking
