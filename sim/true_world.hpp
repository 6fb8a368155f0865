#pragma once

#include <cstdint>

#include "vigia/core/world_map.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/sim/disturbances.hpp"

namespace vigia::sim {

/// The room as it is, made from the map that the robot has: landmarks that hang off their places
/// or are missing. Everything by streams of its own from @p seed.
WorldMap true_world(const WorldMap& map, const DisturbanceParams& disturbances, std::uint64_t seed);

/// The look of the room with what the disturbances put on its walls.
Appearance true_appearance(const Appearance& appearance, const WorldMap& world,
                           const DisturbanceParams& disturbances, std::uint64_t seed);

}  // namespace vigia::sim
