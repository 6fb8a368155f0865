#pragma once

#include <optional>
#include <string>

#include "vigia/core/ceiling_grid.hpp"
#include "vigia/core/config.hpp"
#include "vigia/core/field_map.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/landmark.hpp"

namespace vigia {

class ParamVisitor;

/// What the robot knows of the building: plan, ground, landmarks, the field on its floor, the
/// patches on its ceiling.
struct WorldMap {
  std::string name = "world";
  FloorPlan plan;  ///< in plan coordinates, heights above the ground
  Ground ground;
  LandmarkMap landmarks;
  std::optional<FieldMap> field = std::nullopt;
  std::optional<CeilingGrid> ceiling = std::nullopt;

  /// Where a landmark hangs in the plan.
  Eigen::Vector2d in_plan(const Landmark& landmark) const {
    return ground.in_plan(landmark.centre_w()).head<2>();
  }
};

/// The keys `name`, `room`, `walls`, `obstacles`, `ground`, `landmarks`, `field`, `ceiling` of a
/// world file. A reader throws InputError: a landmark inside a wall or outside the room, off every
/// face, overlapping ids, …
void describe(ParamVisitor& v, WorldMap& world);

/// Reads them; the reader stays the caller's to finish.
WorldMap read_world_map(MapReader& reader);

}  // namespace vigia
