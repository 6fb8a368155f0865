#pragma once

#include "world_checks.hpp"

#include "vigia/core/params.hpp"

namespace vigia {

/// The keys of one item of a world's `landmarks`. The reader is left to the caller.
void describe(ParamVisitor& v, PlacedLandmark& placed);

}  // namespace vigia
