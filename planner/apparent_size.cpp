#include "vigia/planner/apparent_size.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::planner {
namespace {

constexpr double kTagFields = 8.0;  // from edge to edge of the black square

}  // namespace

double wanted_radius(const Landmark& landmark, const HeadModel& head) {
  if (disc_radius(landmark)) return head.radius_px;
  return head.fill * 0.5 * head.zoom.at(head.zoom.min_zoom_mm()).height;
}

double zoom_for(const Landmark& landmark, double range_m, const HeadModel& head) {
  return head.zoom.zoom_for_focal(wanted_radius(landmark, head) * range_m /
                                  extent_radius(landmark));
}

std::optional<double> feature_width(const Landmark& landmark, double range_m, double view_angle,
                                    double focal_px) {
  double width_m = 0.0;
  if (const auto* pattern = std::get_if<PatternShape>(&landmark.shape))
    width_m = 2.0 * pattern->dot_radius_m;
  else if (const auto* tag = std::get_if<TagShape>(&landmark.shape))
    width_m = tag->side_m / kTagFields;
  else
    return std::nullopt;
  return focal_px * width_m * std::max(std::cos(view_angle), 0.0) / range_m;
}

}  // namespace vigia::planner
