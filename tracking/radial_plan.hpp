#pragma once

#include <cstdint>
#include <vector>

#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/radial_scan.hpp"

namespace vigia::tracking {

/// A place on a ray between two pixels that are neighbours across the ray's major axis.
struct PlannedSample {
  std::int32_t near = 0;  ///< into what is read
  std::int32_t far = 0;
  float share = 0.0F;  ///< of far, in [0, 1)
  /// Variance of the mixture, where each pixel has 1.
  float variance() const { return (1.0F - share) * (1.0F - share) + share * share; }
};

/// The samples of one ray: sample i lies start_px + i·step_px from the middle.
struct PlannedRay {
  int first = 0;
  int count = 0;
  double start_px = 0.0;
  double step_px = 1.0;
  double radius(double i) const { return start_px + i * step_px; }
};

/// Which pixels a scan reads, and where each ray's samples lie among them.
struct RadialPlan {
  int width = 0;
  int height = 0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< from which the rays go
  std::vector<imaging::Run> runs;
  std::size_t pixels = 0;
  std::vector<PlannedRay> rays;
  std::vector<PlannedSample> samples;
};

RadialPlan plan_rays(const MirrorImage& mirror, int rays, int width, int height);

}  // namespace vigia::tracking
