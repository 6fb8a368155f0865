#pragma once

#include <algorithm>
#include <vector>

#include "vigia/core/actuation.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/odometry.hpp"

namespace vigia::mission {

/// What the robot's own sensors say at the end of a tick.
struct Readings {
  Stamp now;
  Duration dt;                 ///< of the tick
  OdometryIncrement odometry;  ///< of the tick
  double travelled_m = 0.0;    ///< since the mission began, by odometry
  HeadReading head;
  std::vector<Shot> shots;  ///< what an exposure now is taken with, for each camera of the rig

  /// Of that camera, which the rig must have.
  const Shot& shot_of(CameraId camera) const;
  /// Mean over the tick, by odometry.
  BaseRates base_rates() const { return mean_rates(odometry); }
};

inline const Shot& Readings::shot_of(CameraId camera) const {
  return *std::find_if(shots.begin(), shots.end(),
                       [camera](const Shot& shot) { return shot.camera == camera; });
}

/// What base and head are asked for until the next tick.
struct Commands {
  BaseRates base;
  HeadRates head;
};

}  // namespace vigia::mission
