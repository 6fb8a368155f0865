#pragma once

#include <optional>

#include "vigia/core/landmark.hpp"
#include "vigia/planner/head_model.hpp"

namespace vigia::planner {

/// The radius, px, with which a landmark's extent_radius() is to appear: all discs alike, patterns
/// and tags as large as the image takes them.
double wanted_radius(const Landmark& landmark, const HeadModel& head);

/// The zoom position that shows a landmark at @p range_m with the wanted radius, as far as the
/// zoom goes.
double zoom_for(const Landmark& landmark, double range_m, const HeadModel& head);

/// Narrow width in the image, px, of what must be distinguished at @p focal_px: a pattern's ring
/// dot or a tag's field, foreshortened by the view angle (rad). Nothing for a disc.
std::optional<double> feature_width(const Landmark& landmark, double range_m, double view_angle,
                                    double focal_px);

}  // namespace vigia::planner
