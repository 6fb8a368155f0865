#include "zoom_classes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vigia/planner/apparent_size.hpp"

namespace vigia::planner {
namespace {

std::optional<double> smallest_disc(const LandmarkMap& landmarks) {
  std::optional<double> radius;
  for (const Landmark& landmark : landmarks.all())
    if (const auto disc = disc_radius(landmark)) radius = std::min(radius.value_or(*disc), *disc);
  return radius;
}

}  // namespace

ZoomClasses::ZoomClasses(const LandmarkMap& landmarks, const HeadModel& head,
                         double distance_ratio) {
  const auto disc = smallest_disc(landmarks);
  if (disc) classes_.push_back({head.radius_px, *disc});
  for (const Landmark& landmark : landmarks.all()) {
    if (disc_radius(landmark)) {
      index_[landmark.id] = 0;
      continue;
    }
    const double radius = extent_radius(landmark);
    const auto known = std::find_if(
        classes_.begin() + (disc ? 1 : 0), classes_.end(),
        [radius](const ZoomClass& each) { return std::abs(each.radius_m - radius) < 1e-9; });
    index_[landmark.id] = static_cast<std::size_t>(known - classes_.begin());
    if (known == classes_.end())
      classes_.push_back({wanted_radius(landmark, head) / std::sqrt(distance_ratio), radius});
  }
}

}  // namespace vigia::planner
