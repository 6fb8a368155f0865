#include "vigia/localization/mirror_self_calibration.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/localization/field_localizer.hpp"

namespace vigia::localization {
namespace {

/// The soccer robot's mirror, as it was calibrated.
MirrorOnRobot soccer_mirror_on_robot() {
  MirrorOnRobot camera;
  camera.mirror.px = 204.0;
  camera.mirror.py = -204.0;
  camera.mirror.max_angle = from_deg(99.0);
  camera.rMc = Eigen::Translation3d(0.0, 0.0, 0.75) *
               Eigen::AngleAxisd(kPi, Eigen::Vector3d(1.0, 1.0, 0.0).normalized());
  return camera;
}

MirrorErrors some_errors() {
  MirrorErrors errors;
  errors << 0.004, from_deg(0.1), from_deg(-0.08), 0.3, -0.3;
  return errors;
}

TEST(MirrorSelfCalibration, AFloorPointMovesWithTheMirrorsErrorsAsItsJacobianSays) {
  const MirrorOnRobot camera = soccer_mirror_on_robot();
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(3.0, 1.0), Eigen::Vector2d(-0.8, 0.5)}) {
    const Eigen::Vector2d uv = camera.pixel_of(p).value();
    const FloorOfPixel floor = floor_of_pixel(camera, uv).value();
    EXPECT_LT((floor.p_r - p).norm(), 1e-9);
    for (int i = 0; i < kMirrorErrors; ++i) {
      const double h = i < 3 ? 1e-6 : 1e-4;
      const MirrorErrors step = h * MirrorErrors::Unit(i);
      const Eigen::Vector2d more = floor_of_pixel(camera.with(step), uv)->p_r;
      const Eigen::Vector2d less = floor_of_pixel(camera.with(-step), uv)->p_r;
      const Eigen::Vector2d slope = (more - less) / (2.0 * h);
      EXPECT_LT((slope - floor.dp_derrors.col(i)).norm(), 1e-5 * (1.0 + slope.norm())) << i;
    }
  }
}

FieldMap field_12x8() {
  MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/fields/12x8.yaml"), "file");
  return read_field_map(reader.map("field"));
}

/// What a robot there makes of the pixels of the lines within 5 m through a camera that has errors.
FieldObservation seen_through(const MirrorErrors& errors, const FieldMap& field, const Pose2& pose,
                              Stamp stamp) {
  const MirrorOnRobot calibrated = soccer_mirror_on_robot();
  const MirrorOnRobot true_camera = calibrated.with(errors);
  FieldObservation seen;
  seen.shot.stamp = seen.scan.stamp = stamp;
  seen.shot.model = calibrated.mirror;
  for (int i = 0; i < 90; ++i) {
    std::vector<LineCrossing> crossings;
    const double angle = 2.0 * kPi * i / 90.0;
    for (const FieldLine& line : field.lines)
      cross_line(line, pose.position(), unit_vector(angle), 5.0, crossings);
    for (const LineCrossing& crossing : crossings) {
      const Eigen::Vector2d p_r = crossing.range_m * unit_vector(angle - pose.theta);
      const auto uv = true_camera.pixel_of(p_r);
      const auto floor = uv ? floor_of_pixel(calibrated, *uv) : std::nullopt;
      if (floor)
        seen.scan.points.push_back(
            {floor->p_r, std::pow(0.003 * crossing.range_m, 2) * Eigen::Matrix2d::Identity()});
    }
  }
  return seen;
}

/// Position error at the end of a drive of four seconds across the field.
double error_after_drive(FieldLocalizer& localizer, const MirrorErrors& errors) {
  const FieldMap field = field_12x8();
  Pose2 pose{-3.0, -1.5, 0.3};
  localizer.reset({}, Prior{pose, Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal()});
  for (int i = 0; i < 100; ++i) {
    const OdometryIncrement u{Stamp::from_seconds(0.04 * i), Stamp::from_seconds(0.04 * (i + 1)),
                              0.005, 0.05, 0.005};
    pose = move(pose, u);
    localizer.predict(u);
    localizer.update(seen_through(errors, field, pose, u.to));
  }
  return (localizer.belief().pose.position() - pose.position()).norm();
}

MirrorOfRig soccer_rig() {
  const MirrorOnRobot camera = soccer_mirror_on_robot();
  MirrorOfRig mirror;
  mirror.rig.cameras.push_back({0, FixedMount{camera.rMc}, CameraModel{camera.mirror}});
  return mirror;
}

TEST(MirrorSelfCalibration, APoseIsRightThoughTheMirrorIsNotWhatItWasCalibratedAs) {
  const auto plain = make_field_tracker(field_12x8(), {});
  const auto calibrating = make_field_tracker(field_12x8(), {}, soccer_rig());
  EXPECT_GT(error_after_drive(*plain, some_errors()), 0.02);
  EXPECT_LT(error_after_drive(*calibrating, some_errors()), 0.005);
}

TEST(MirrorSelfCalibration, ABeliefIsWiderByWhatIsNotKnownOfTheMirror) {
  const auto plain = make_field_tracker(field_12x8(), {});
  const auto calibrating = make_field_tracker(field_12x8(), {}, soccer_rig());
  error_after_drive(*plain, MirrorErrors::Zero());
  error_after_drive(*calibrating, MirrorErrors::Zero());
  EXPECT_GT(calibrating->belief().position_sigma(), 1.05 * plain->belief().position_sigma());
}

}  // namespace
}  // namespace vigia::localization
