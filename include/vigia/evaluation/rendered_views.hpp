#pragma once

#include <cstdint>
#include <vector>

#include "vigia/evaluation/pattern_views.hpp"
#include "vigia/evaluation/quixote_setting.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::evaluation {

/// What the pattern tracker read in rendered views.
struct RenderedViews {
  std::vector<PatternView> read;  ///< with the tracker's points and covariances
  int rejected = 0;               ///< nothing was read
  int wrong = 0;                  ///< another pattern than the one in the picture's middle was read
};

/// Renders each view's picture in the textured room, with the noise and the blur of @p imaging, and
/// looks for the pattern in the whole of it, without prediction. @p views tell pattern and camera.
RenderedViews render_views(const QuixoteSetting& setting, const std::vector<PatternView>& views,
                           const sim::ImagingParams& imaging, std::uint64_t seed);

}  // namespace vigia::evaluation
