#pragma once

#include "surface.hpp"

#include "vigia/core/ground.hpp"

namespace vigia::sim {

/// The surfaces of a building that stands on folded ground: upright faces cut where the ground
/// folds, then floors, ceilings so high above them, and the tops of the obstacles. A wall between
/// two floors of different height stands on the lower one and reaches as high as on the higher one.
std::vector<Surface> building_surfaces(const FloorPlan& plan, const Ground& ground,
                                       const Appearance& appearance);

/// Frame of what is painted on the ground or, @p height_m above it and its z pointing down, on the
/// ceiling.
Eigen::Isometry3d painted_frame(const Ground& ground, const Eigen::Vector2d& p, double height_m,
                                bool on_ceiling);

}  // namespace vigia::sim
