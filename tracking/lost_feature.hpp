#pragma once

#include "vigia/tracking/ellipse_tracker.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::tracking {

/// A feature that is not there, and why.
inline EllipseFeature lost_ellipse(FeatureStatus status, double score = 0.0) {
  EllipseFeature feature;
  feature.status = status;
  feature.score = score;
  return feature;
}

inline PointsFeature lost_points(FeatureStatus status) {
  PointsFeature feature;
  feature.status = status;
  return feature;
}

}  // namespace vigia::tracking
