#pragma once

#include "vigia/core/camera.hpp"

namespace vigia::sim {

/// Rays (x, y, 1) of @p count pixels of row @p v from column @p u on, through the lens.
void row_rays(const Intrinsics& intrinsics, int u, int v, int count, float* x, float* y);

}  // namespace vigia::sim
