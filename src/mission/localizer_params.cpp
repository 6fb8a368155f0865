#include "localizer_params.hpp"

#include <algorithm>

#include "vigia/localization/ekf.hpp"
#include "vigia/localization/odometry_localizer.hpp"

namespace vigia::mission {

localization::PatternFixParams pattern_fix_params(const MissionSetup& setup) {
  localization::PatternFixParams params;
  params.odometry = setup.ekf.odometry;
  params.sensor = setup.ekf.sensor;
  return params;
}

localization::LandmarkInformation landmark_information(const MissionSetup& setup) {
  const auto& head = setup.robot.robot.head;
  localization::PointsInformationParams points;
  points.sensor = setup.ekf.sensor;
  points.fill = setup.look.fill;
  return {localization::DiscInformation(
              head, setup.robot.zoom, {setup.ekf.sensor, setup.look.radius_px}, setup.world.ground),
          localization::PointsInformation(head, setup.robot.zoom, points, setup.world.ground)};
}

std::unique_ptr<localization::Localizer> make_localizer(const std::string& name,
                                                        const MissionSetup& setup) {
  if (name == "odometry")
    return std::make_unique<localization::OdometryLocalizer>(setup.ekf.odometry);
  if (name == "pattern_fix")
    return std::make_unique<localization::PatternFixLocalizer>(
        setup.world.landmarks, setup.on_ground(), pattern_fix_params(setup));
  return std::make_unique<localization::EkfLocalizer>(setup.world.landmarks, setup.on_ground(),
                                                      setup.ekf, setup.world.plan);
}

localization::RelocalizerParams relocalizer_params(const MissionSetup& setup) {
  localization::RelocalizerParams params;
  params.sensor = setup.ekf.sensor;
  params.centre_floor_px = std::max(params.centre_floor_px, setup.ekf.centre_floor_px);
  params.size_floor = std::max(params.size_floor, setup.ekf.size_floor);
  params.explained_share = setup.recovery.explained_share;
  return params;
}

}  // namespace vigia::mission
