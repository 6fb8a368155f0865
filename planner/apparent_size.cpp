#include "vigia/planner/apparent_size.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/overloaded.hpp"

namespace vigia::planner {
namespace {

constexpr double kTagFields = 8.0;  // from edge to edge of the black square

}  // namespace

double wanted_radius(const Landmark& landmark, const HeadModel& head) {
  const auto filling = [&head] {
    return head.fill * 0.5 * head.zoom.at(head.zoom.min_zoom_mm()).height;
  };
  return std::visit(Overloaded{[&head](const DiscShape&) { return head.radius_px; },
                               [&filling](const PatternShape&) { return filling(); },
                               [&filling](const TagShape&) { return filling(); }},
                    landmark.shape);
}

double zoom_for(const Landmark& landmark, double range_m, const HeadModel& head) {
  return head.zoom.zoom_for_focal(wanted_radius(landmark, head) * range_m /
                                  extent_radius(landmark));
}

std::optional<double> feature_width(const Landmark& landmark, double range_m, double view_angle,
                                    double focal_px) {
  using Width = std::optional<double>;
  const Width width_m = std::visit(
      Overloaded{[](const DiscShape&) -> Width { return std::nullopt; },
                 [](const PatternShape& pattern) -> Width { return 2.0 * pattern.dot_radius_m; },
                 [](const TagShape& tag) -> Width { return tag.side_m / kTagFields; }},
      landmark.shape);
  if (!width_m) return std::nullopt;
  return focal_px * *width_m * std::max(std::cos(view_angle), 0.0) / range_m;
}

}  // namespace vigia::planner
