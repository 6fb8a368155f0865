#include "vigia/core/observation.hpp"

#include <algorithm>

#include "vigia/core/overloaded.hpp"

namespace vigia {
namespace {

constexpr std::size_t kTagCorners = 4;

/// How far the point of that label lies from the landmark's centre, as a share of extent_radius().
double share_of_extent(int label, const Landmark& landmark) {
  return std::visit(Overloaded{[](const DiscShape&) { return 1.0; },
                               [&](const PatternShape& pattern) {
                                 if (label == 0) return 1.0;
                                 const double ring = label <= kDotsPerRing ? pattern.outer_radius_m
                                                                           : pattern.inner_radius_m;
                                 return ring / extent_radius(landmark);
                               },
                               [](const TagShape&) { return 1.0; }},
                    landmark.shape);
}

/// The centre-point of a pattern where it is seen, else the points' mean.
Eigen::Vector2d centre_of(const std::vector<LabelledPoint>& points) {
  for (const LabelledPoint& point : points)
    if (points.size() > kTagCorners && point.label == 0) return point.uv;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const LabelledPoint& point : points) sum += point.uv;
  return sum / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

ImageExtent extent_of(const PointsObservation& seen, const Landmark* landmark) {
  ImageExtent extent{centre_of(seen.points), 0.0};
  for (const LabelledPoint& point : seen.points) {
    const double share = landmark == nullptr ? 1.0 : share_of_extent(point.label, *landmark);
    extent.radius_px = std::max(extent.radius_px, (point.uv - extent.centre).norm() / share);
  }
  return extent;
}

}  // namespace

std::optional<LandmarkImage> landmark_image(const Observation& observation) {
  using Image = std::optional<LandmarkImage>;
  return std::visit(Overloaded{[](const EllipseObservation& seen) { return Image(&seen); },
                               [](const PointsObservation& seen) { return Image(&seen); },
                               [](const FieldObservation&) { return Image(); },
                               [](const PatchesObservation&) { return Image(); },
                               [](const StereoObservation&) { return Image(); },
                               [](const FlowObservation&) { return Image(); }},
                    observation);
}

ImageExtent image_extent(const Observation& observation, const Landmark* landmark) {
  const auto image = landmark_image(observation);
  if (!image) return {};
  return std::visit(
      Overloaded{[](const EllipseObservation* seen) {
                   const Ellipse& ellipse = seen->ellipse;
                   return ImageExtent{{ellipse.u, ellipse.v}, ellipse.a};
                 },
                 [&](const PointsObservation* seen) { return extent_of(*seen, landmark); }},
      *image);
}

bool shows_landmark(const Observation& observation) {
  return landmark_image(observation).has_value();
}

const Shot& shot_of(const Observation& observation) {
  return std::visit([](const auto& seen) -> const Shot& { return seen.shot; }, observation);
}

}  // namespace vigia
