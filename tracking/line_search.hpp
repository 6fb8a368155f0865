#pragma once

#include "ray_samples.hpp"

#include <array>
#include <vector>

#include "vigia/tracking/radial_scan.hpp"

namespace vigia::tracking {

/// What the search for lines on the rays has found, and refused by reason.
struct LineSearchResult {
  std::vector<LinePoint> points;
  std::vector<double> blurs_px;
  std::array<int, kRunFaults> refused{};
};

/// The lines that the rays cross. @p view: where the floor is known.
LineSearchResult search_lines(const RadialPlan& plan, const RaySamples& samples,
                              const FieldPalette& palette, const RadialScanParams& params,
                              const FloorView* view);

}  // namespace vigia::tracking
