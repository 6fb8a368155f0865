#pragma once

#include <memory>
#include <vector>

#include "vigia/core/name_table.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::tracking {

/// A tracker makes one of two: an ellipse of a disc, or the labelled points of a landmark that says
/// who it is. The scans of a field and of a ceiling make neither: they follow nothing.
struct TrackerEntry : NameEntry {
  std::unique_ptr<EllipseTracker> (*make_ellipse)();
  std::unique_ptr<PointTracker> (*make_points)(const KnownCodes& known);
};

/// Every tracker, those of ellipses first.
const std::vector<TrackerEntry>& trackers();

/// The names of the trackers of ellipses.
std::vector<std::string> ellipse_tracker_names();

}  // namespace vigia::tracking
