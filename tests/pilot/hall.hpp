#pragma once

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/path.hpp"

namespace vigia::pilot {

/// An empty room of 10 × 6 m.
inline FloorPlan hall() {
  return FloorPlan({{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}}, 2.8, {}, {});
}

/// Along its middle.
inline Path straight() {
  return Path({{1.0, 3.0}, {9.0, 3.0}}).resampled(0.05);
}

}  // namespace vigia::pilot
