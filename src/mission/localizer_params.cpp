#include "localizer_params.hpp"

#include <algorithm>

namespace vigia::mission {

localization::PatternFixParams pattern_fix_params(const MissionSetup& setup) {
  localization::PatternFixParams params;
  params.odometry = setup.noise.odometry;
  params.sensor = setup.noise.sensor;
  return params;
}

localization::RelocalizerParams relocalizer_params(const MissionSetup& setup) {
  localization::RelocalizerParams params;
  params.sensor = setup.noise.sensor;
  params.centre_floor_px = std::max(params.centre_floor_px, setup.noise.centre_floor_px);
  params.size_floor = std::max(params.size_floor, setup.noise.size_floor);
  params.explained_share = setup.recovery.explained_share;
  return params;
}

}  // namespace vigia::mission
