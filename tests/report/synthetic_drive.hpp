#pragma once

#include "vigia/report/map_picture.hpp"

namespace vigia::report::test {

/// A room of 12 × 7 m with three obstacles, a partition and six landmarks.
WorldMap synthetic_world();

/// A drive round that room: truth beside the plan, an estimate that is corrected at each look, and
/// odometry that drifts away.
MapDrive synthetic_drive(const WorldMap& world);

}  // namespace vigia::report::test
