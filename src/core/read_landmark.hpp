#pragma once

#include "world_checks.hpp"

namespace vigia {

/// Reads one entry of `landmarks`: `id`, `kind`, `centre_m`, `normal_deg`, `free_standing` and the
/// keys of its kind. Throws InputError.
PlacedLandmark read_landmark(MapReader reader);

}  // namespace vigia
