#pragma once

#include "body_view.hpp"
#include "lamp.hpp"
#include "surface.hpp"

#include <vector>

#include "vigia/core/field_map.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/sim/appearance.hpp"

namespace vigia::sim {

/// Height of a field's carpet above the floor of its hall, m. The carpet lies at z = 0.
inline constexpr double kCarpet_m = 0.005;

/// The carpet, of field and margin.
Surface carpet_surface(const FieldMap& field, const Appearance& look);

/// Goals: sides and back in the goal's colour, posts and bar white; a white goal has a grey net.
std::vector<Surface> goal_surfaces(const FieldMap& field, const Appearance& look);

/// Advertising boards in bright colours round the carpet, as far as the hall has room.
std::vector<Surface> advert_surfaces(const FieldMap& field, const FloorPlan& plan,
                                     const Appearance& look);

/// What stands about and does not move: corner posts in their bands, and people who watch from
/// beside the carpet.
std::vector<BodyPart> post_parts(const FieldMap& field);
std::vector<BodyPart> spectator_parts(const FieldMap& field, const FloorPlan& plan,
                                      const Appearance& look);

/// Of a colour that is painted on goals and posts.
Ink field_ink(FieldColour colour);

}  // namespace vigia::sim
