#pragma once

#include <string>

#include "vigia/core/config.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/landmark.hpp"

namespace vigia {

/// What the robot knows of the building: plan, ground and landmarks.
struct WorldMap {
  std::string name;
  FloorPlan plan;
  Ground ground;
  LandmarkMap landmarks;
};

/// Reads the keys `name`, `room`, `walls`, `obstacles`, `landmarks` of a world file. Throws
/// InputError: a landmark inside a wall or outside the room, off every face, overlapping ids, …
WorldMap read_world_map(MapReader& reader);

}  // namespace vigia
