#pragma once

#include "ray_samples.hpp"

#include <vector>

#include "vigia/tracking/radial_scan.hpp"

namespace vigia::tracking {

struct ColourSearchResult {
  std::vector<ColourSpan> goals;
  std::vector<ColourSpan> posts;
};

/// Goals and corner posts that the rays meet.
ColourSearchResult search_colours(const RadialPlan& plan, const RaySamples& samples,
                                  const RadialScanParams& params);

}  // namespace vigia::tracking
