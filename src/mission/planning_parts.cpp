#include "vigia/mission/planning_parts.hpp"

namespace vigia::mission {

planner::Visibility visibility(const MissionSetup& setup) {
  return {setup.world.plan, setup.robot.robot.head, setup.robot.robot.head_limits,
          setup.look.visibility, setup.world.ground};
}

planner::HeadModel head_model(const MissionSetup& setup) {
  return {setup.robot.robot.head, setup.robot.robot.head_limits,
          setup.robot.zoom(),     setup.look.radius_px,
          setup.look.dwell_s,     setup.look.fill,
          setup.world.ground};
}

localization::LandmarkInformation landmark_information(const MissionSetup& setup) {
  localization::LandmarkInformationParams params;
  params.sensor = setup.noise.sensor;
  params.radius_px = setup.look.radius_px;
  params.fill = setup.look.fill;
  return {setup.robot.robot.head, setup.robot.zoom(), params, setup.world.ground};
}

}  // namespace vigia::mission
