#pragma once

#include "decal.hpp"

#include <vector>

#include "vigia/core/landmark.hpp"
#include "vigia/sim/appearance.hpp"

namespace vigia::sim {

/// Half the width of the sheet that a landmark is printed on.
double sheet_half_width(const Landmark& landmark, const Appearance& look);

/// A landmark's sheet and what is printed on it, in the order in which they are painted.
std::vector<Decal> landmark_decals(const Landmark& landmark, const Appearance& look);

}  // namespace vigia::sim
