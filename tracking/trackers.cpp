#include "vigia/tracking/trackers.hpp"

#include "vigia/tracking/correlation_tracker.hpp"
#include "vigia/tracking/disc_tracker.hpp"
#include "vigia/tracking/moving_edge_tracker.hpp"
#include "vigia/tracking/pattern_tracker.hpp"
#include "vigia/tracking/tag_tracker.hpp"

namespace vigia::tracking {
namespace {

template <typename Tracker>
std::unique_ptr<EllipseTracker> ellipse() {
  return std::make_unique<Tracker>();
}

template <typename Tracker>
std::unique_ptr<PointTracker> points(const KnownCodes& known) {
  return std::make_unique<Tracker>(known);
}

}  // namespace

const std::vector<TrackerEntry>& trackers() {
  static const std::vector<TrackerEntry> table{
      {{"disc", "dark discs by their outline and grey levels", "discs"},
       &ellipse<DiscTracker>,
       nullptr},
      {{"ellipse", "dark discs by moving edges (ViSP)", "discs"},
       &ellipse<MovingEdgeTracker>,
       nullptr},
      {{"correlation", "dark discs by a grey-scale template", "discs"},
       &ellipse<CorrelationTracker>,
       nullptr},
      {{"pattern", "colour patterns, which say floor, room and pattern", "patterns, colour"},
       nullptr,
       &points<PatternTracker>},
      {{"tag", "AprilTags of the family 36h11", "tags"}, nullptr, &points<TagTracker>},
      {{"field_scan", "lines, goals and posts of a field in a mirror camera's pictures", "colour"},
       nullptr,
       nullptr},
      {{"ceiling", "patches of a ceiling in the pictures of a camera that looks up", "patches"},
       nullptr,
       nullptr},
  };
  return table;
}

std::vector<std::string> ellipse_tracker_names() {
  std::vector<std::string> names;
  for (const TrackerEntry& entry : trackers())
    if (entry.make_ellipse != nullptr) names.push_back(entry.name);
  return names;
}

std::unique_ptr<EllipseTracker> make_ellipse_tracker(const std::string& name) {
  const TrackerEntry* entry = find_name(trackers(), name);
  const bool known = entry != nullptr && entry->make_ellipse != nullptr;
  return known ? entry->make_ellipse() : nullptr;
}

std::unique_ptr<PointTracker> make_point_tracker(const std::string& name, const KnownCodes& known) {
  const TrackerEntry* entry = find_name(trackers(), name);
  return entry != nullptr && entry->make_points != nullptr ? entry->make_points(known) : nullptr;
}

}  // namespace vigia::tracking
