#pragma once

#include <vector>

#include "vigia/core/observation.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::tracking {

/// The part of @p frame within @p margin pixels of the points' upright bounding box.
imaging::Window window_of(const std::vector<LabelledPoint>& points, double margin,
                          const imaging::Window& frame);
Eigen::Vector2d middle_of(const std::vector<LabelledPoint>& points);
/// The largest distance of a point from the middle.
double extent_of(const std::vector<LabelledPoint>& points);
bool reaches_over(const std::vector<LabelledPoint>& points, const imaging::Window& frame);

/// How far from its points a predicted landmark's outline may be seen, px.
double reach_of(const PointsPrediction& prediction);

}  // namespace vigia::tracking
