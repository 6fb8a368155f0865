#pragma once

#include <optional>
#include <string_view>

#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/stamp.hpp"

namespace vigia {

/// What the planner asks of the head. The latest order counts; servo and planner meet only here.
struct GazeOrder {
  LookId look = 0;
  LandmarkId landmark = 0;
  Stamp issued;
  Stamp expires;            ///< without a feature by then, the order ends as failed
  double dwell_s = 1.0;     ///< how long the landmark is watched once it is tracked
  double radius_px = 24.0;  ///< apparent semi-major axis that the zoom holds …
  /// … unless the plan has set a zoom, which then stays as it is while the landmark fits the image.
  std::optional<double> zoom_mm;
};

/// What an eye is asked to do with a capture.
enum class TrackRequest { none, acquire, track };

/// What an attention asks of the eye that it directs.
struct GazeRequest {
  LandmarkId landmark = 0;
  TrackRequest track = TrackRequest::acquire;
};

/// What the gaze does now.
enum class GazeState { idle, slew, acquire, track, lost, search };

std::string_view to_string(GazeState state);

}  // namespace vigia
