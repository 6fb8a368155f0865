#pragma once

#include <vector>

#include "vigia/core/camera.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/random.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/disc_model.hpp"

namespace vigia::localization::test {

/// A disc of 0.1 m radius on a wall.
inline Landmark disc(LandmarkId id, double x, double y, double z, double normal_yaw_deg,
                     double radius_m = 0.1) {
  return {id, wall_mount({x, y, z}, from_deg(normal_yaw_deg)), DiscShape{radius_m}};
}

/// A 12×7 m room with six discs and two partitions.
inline LandmarkMap room_landmarks() {
  return LandmarkMap({disc(0, 3.1, 0.0, 1.6, 90.0), disc(1, 8.7, 0.0, 1.5, 90.0),
                      disc(2, 12.0, 2.6, 1.7, 180.0), disc(3, 9.3, 7.0, 1.4, -90.0),
                      disc(4, 4.2, 7.0, 1.6, -90.0), disc(6, 0.0, 4.3, 1.5, 0.0)});
}

inline FloorPlan room_plan() {
  return FloorPlan({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8,
                   {Wall{{6.0, 0.0}, {6.0, 2.0}, 2.8}, Wall{{6.0, 7.0}, {6.0, 5.2}, 2.8}}, {});
}

/// 640×480, 8–48 mm, 700–4200 px.
inline ZoomCalibration zoom_calibration() {
  return ZoomCalibration(640, 480, 319.5, 239.5, {{8.0, 700.0, 0.05}, {48.0, 4200.0, 0.002}});
}

/// The zoom that shows a disc with semi-major axis @p radius_px, where it can.
inline Intrinsics zoomed(const ZoomCalibration& zoom, double range_m, double radius_m,
                         double radius_px) {
  return zoom.at(zoom.zoom_for_focal(radius_px * range_m / radius_m));
}

inline LookBias draw_bias(RandomStream& random, const SensorNoise& noise) {
  const double pan = noise.look_angle * random.normal();
  const double tilt = noise.look_angle * random.normal();
  return {pan, tilt, noise.look_focal * random.normal()};
}

/// What a head that believes to aim at the landmark reports, with the true angles off by the bias.
inline Shot aimed_shot(const Landmark& landmark, const HeadGeometry& geometry, const Pose2& pose,
                       const LookBias& bias, LookId look, Stamp stamp, double radius_px = 24.0) {
  const Eigen::Vector3d p_r = to_isometry(pose).inverse() * landmark.centre_w();
  const HeadAngles aim = aim_at(geometry, p_r);
  Shot shot;
  shot.stamp = stamp;
  shot.look = look;
  shot.head = {aim.pan - bias.pan, aim.tilt - bias.tilt};
  const double range = (p_r - geometry.mount_r).norm();
  const ZoomCalibration zoom = zoom_calibration();
  shot.model = zoomed(zoom, range, *disc_radius(landmark), radius_px);
  shot.zoom_mm = zoom.zoom_for_focal(pinhole(shot).px);
  return shot;
}

/// The disc as the camera saw it: the true head is at reading + bias + white part, and the ellipse
/// is measured with @p pixel_sigma on the centre and on both axes.
inline EllipseObservation observe(const Landmark& landmark, Shot shot, const HeadGeometry& geometry,
                                  const Pose2& truth, const LookBias& bias, double reading_angle,
                                  double pixel_sigma, RandomStream& random) {
  HeadAngles head{shot.head.pan + bias.pan, shot.head.tilt + bias.tilt};
  head.pan += reading_angle * random.normal();
  head.tilt += reading_angle * random.normal();
  Intrinsics intrinsics = pinhole(shot);
  intrinsics.px *= std::exp(bias.log_focal);
  intrinsics.py *= std::exp(bias.log_focal);
  EllipseObservation observation;
  observation.ellipse =
      *disc_image(landmark, intrinsics, to_isometry(truth) * camera_in_base(geometry, head));
  observation.ellipse.u += pixel_sigma * random.normal();
  observation.ellipse.v += pixel_sigma * random.normal();
  observation.ellipse.a += pixel_sigma * random.normal();
  observation.ellipse.b += pixel_sigma * random.normal();
  observation.covariance *= pixel_sigma * pixel_sigma;
  observation.shot = shot;
  observation.expected = landmark.id;
  return observation;
}

}  // namespace vigia::localization::test
