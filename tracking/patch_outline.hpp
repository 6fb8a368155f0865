#pragma once

#include "normal_table.hpp"
#include "patch_fit.hpp"

#include <cmath>
#include <vector>

namespace vigia::tracking {

/// The patch's share of a pixel and its derivatives by the pixel's place in the patch's frame (x
/// forward), by the blur, and by the log of the size.
struct Share {
  float value = 0.0F;
  float dx = 0.0F;
  float dy = 0.0F;
  float dblur_x = 0.0F;  ///< by the blur along x, along y
  float dblur_y = 0.0F;
  float dxy = 0.0F;

  float dblur() const { return dblur_x + dblur_y; }
};

/// Φ(t/s) at an edge, and what it adds to the derivatives.
struct EdgeSide {
  float value;
  float density;  ///< ∂/∂t
  float blur;     ///< ∂/∂s
};

inline EdgeSide side(float t, float per_blur) {
  const float z = t * per_blur;
  const NormalTable::Value normal = normal_table().at(z);
  const float density = normal.density * per_blur;
  return {normal.integral, density, -z * density};
}

/// Of the rectangle between low and high in x, and within ±half in y.
inline void add_rectangle(const EdgeSide& low, const EdgeSide& high, const EdgeSide& below,
                          const EdgeSide& above, Share& share) {
  const float along = low.value - high.value;
  const float across = below.value - above.value;
  share.value += along * across;
  share.dx += (low.density - high.density) * across;
  share.dy += along * (below.density - above.density);
  share.dblur_x += (low.blur - high.blur) * across;
  share.dblur_y += along * (below.blur - above.blur);
  share.dxy += (low.density - high.density) * (below.density - above.density);
}

/// The patch's outline for one size, px.
struct PatchOutline {
  float half_length;
  float neck;  ///< where the tongue begins
  float half_width;
  float half_tongue;
  bool tongue;

  PatchOutline(const PatchFinderParams& params, double log_scale)
      : half_length(static_cast<float>(0.5 * params.length_px * std::exp(log_scale))),
        neck(static_cast<float>(1.0 - 2.0 * kTongueLength) * half_length),
        half_width(static_cast<float>(0.5 * params.width_px * std::exp(log_scale))),
        half_tongue(static_cast<float>(kTongueWidth) * half_width),
        tongue(params.polarity) {}

  Share share(float x, float y, float per_blur) const {
    Share share;
    const EdgeSide back = side(x + half_length, per_blur);
    const EdgeSide front = side(x - half_length, per_blur);
    const EdgeSide left = side(y + half_width, per_blur);
    const EdgeSide right = side(y - half_width, per_blur);
    if (!tongue) {
      add_rectangle(back, front, left, right, share);
      return share;
    }
    const EdgeSide middle = side(x - neck, per_blur);
    add_rectangle(back, middle, left, right, share);
    add_rectangle(middle, front, side(y + half_tongue, per_blur), side(y - half_tongue, per_blur),
                  share);
    return share;
  }
};

/// A pixel that is fitted.
struct BandPixel {
  float u;
  float v;
  float grey;
};

/// The pixels about a patch and as far as its motion smears it: they stay the same while the shape
/// moves.
std::vector<BandPixel> band_pixels(const PatchWindow& window, const PatchShape& start,
                                   const PatchFinderParams& params);

}  // namespace vigia::tracking
