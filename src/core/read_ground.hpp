#pragma once

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/params.hpp"

namespace vigia {

/// The key `ground` of a world file: pieces that cover the room, hinged along level edges. A reader
/// throws InputError: a gap, an overlap, a step without a wall along it, an obstacle across a fold.
void describe_ground(ParamVisitor& v, const FloorPlan& plan, Ground& ground);

}  // namespace vigia
