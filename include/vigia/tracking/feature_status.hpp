#pragma once

#include <string_view>

namespace vigia::tracking {

/// What became of a frame. Everything but found means: no measurement.
enum class FeatureStatus {
  found,
  not_found,      ///< nothing like the landmark where it was looked for
  occluded,       ///< the landmark, but part of it is hidden
  cut_by_border,  ///< the landmark, cut by the image's border
  wrong_object,   ///< something else, or not the predicted landmark
  low_contrast,   ///< too faint for the noise
  unreadable,     ///< a pattern or tag whose code is in doubt
  unknown_code,   ///< a pattern or tag that is not in the map
};

std::string_view to_string(FeatureStatus status);

}  // namespace vigia::tracking
