#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "vigia/core/landmark.hpp"
#include "vigia/planner/head_model.hpp"

namespace vigia::planner {

/// Landmarks that want the same zoom at the same distance.
struct ZoomClass {
  double planned_px = 0.0;  ///< apparent radius for which a group's zoom is set
  double radius_m = 0.0;

  double zoom_for(double distance_m, const HeadModel& head) const {
    return head.zoom.zoom_for_focal(planned_px * distance_m / radius_m);
  }
};

/// The classes of a map: the discs together, by the smallest of them, then patterns and tags, each
/// size its own. A pattern or tag that fills the image is cut as soon as it comes nearer, so its
/// groups are set for a size smaller by the root of @p distance_ratio, the change of distance
/// within an area.
class ZoomClasses {
 public:
  ZoomClasses(const LandmarkMap& landmarks, const HeadModel& head, double distance_ratio);

  const std::vector<ZoomClass>& all() const { return classes_; }
  /// Of a landmark of the map.
  std::size_t index_of(LandmarkId id) const { return index_.at(id); }
  const ZoomClass& of(LandmarkId id) const { return classes_[index_of(id)]; }

 private:
  std::vector<ZoomClass> classes_;
  std::map<LandmarkId, std::size_t> index_;
};

}  // namespace vigia::planner
