#pragma once

#include "vigia/core/params.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/sim/disturbances.hpp"
#include "vigia/sim/range_ring.hpp"
#include "vigia/sim/simulator.hpp"

namespace vigia::sim {

// The keys of the simulator's parameters (see ParamVisitor).
/// `off` or `realistic` for every disturbance that is left out but kidnapping, and one key each.
void describe(ParamVisitor& v, DisturbanceParams& p);
void describe(ParamVisitor& v, RampErrorParams& p);
void describe(ParamVisitor& v, RangeRingParams& p);
void describe(ParamVisitor& v, RobotSetup& setup);
/// The keys `appearance` and `clutter` of the file of @p world, on whose faces clutter must lie.
/// What is scattered at random is drawn when they are read.
void describe_appearance(ParamVisitor& v, const WorldMap& world, Appearance& appearance);

}  // namespace vigia::sim
