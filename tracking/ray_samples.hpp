#pragma once

#include "radial_plan.hpp"

#include <vector>

#include <visp3/core/vpRGBa.h>

#include "vigia/tracking/field_palette.hpp"

namespace vigia::tracking {

/// What the samples of a plan show. Whiteness is 0 at the palette's green and 1 at its white, along
/// the straight line between them.
struct RaySamples {
  std::vector<vpRGBa> pixels;
  std::vector<float> whiteness;
  std::vector<FieldClass> classes;
  double noise = 0.0;  ///< σ of the whiteness of a pixel

  Eigen::Vector3f rgb(const PlannedSample& sample) const;
};

/// Reads them; @p samples is reused from frame to frame.
void read_samples(const imaging::Frame& frame, const RadialPlan& plan, const FieldPalette& palette,
                  RaySamples& samples);

}  // namespace vigia::tracking
