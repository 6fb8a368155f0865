#include "vigia/localization/mirror_self_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"
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

/// A drive of four seconds along an arc.
struct DriveEnd {
  double error_m = 0.0;
  double turn = 0.0;  ///< error of the heading, rad
  BeliefStatus status = BeliefStatus::lost;
};
DriveEnd end_of_drive(FieldLocalizer& localizer, const MirrorErrors& errors, Pose2 pose) {
  const FieldMap field = field_12x8();
  localizer.reset({}, Prior{pose, Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal()});
  for (int i = 0; i < 100; ++i) {
    const OdometryIncrement u{Stamp::from_seconds(0.04 * i), Stamp::from_seconds(0.04 * (i + 1)),
                              0.02, 0.05, 0.02};
    pose = move(pose, u);
    localizer.predict(u);
    localizer.update(seen_through(errors, field, pose, u.to));
  }
  const Eigen::Vector3d off = difference(localizer.belief().pose, pose);
  return {off.head<2>().norm(), std::abs(off.z()), localizer.belief().status};
}

MirrorErrors drawn_errors(RandomStream& random) {
  const MirrorErrorParams usual;
  MirrorErrors errors;
  for (int i = 0; i < kMirrorErrors; ++i) errors[i] = random.normal();
  errors[0] *= usual.scale;
  errors.segment<2>(1) *= usual.tilt;
  errors.tail<2>() *= usual.centre_px;
  return errors;
}

MirrorOfRig soccer_rig() {
  const MirrorOnRobot camera = soccer_mirror_on_robot();
  MirrorOfRig mirror;
  mirror.rig.cameras.push_back({0, FixedMount{camera.rMc}, CameraModel{camera.mirror}});
  return mirror;
}

TEST(MirrorSelfCalibration, APoseIsRightThoughTheMirrorIsNotWhatItWasCalibratedAs) {
  constexpr int kDrives = 8;
  RandomStream random(6, "mirrors");
  std::vector<double> plain_errors;
  std::vector<double> errors;
  for (int drive = 0; drive < kDrives; ++drive) {
    const MirrorErrors mirror = drawn_errors(random);
    const Pose2 start{random.uniform(-3.0, 3.0), random.uniform(-1.3, 1.3),
                      random.uniform(-kPi, kPi)};
    const auto plain = make_field_tracker(field_12x8(), {});
    const auto calibrating = make_field_tracker(field_12x8(), {}, soccer_rig());
    const DriveEnd by_plain = end_of_drive(*plain, mirror, start);
    const DriveEnd end = end_of_drive(*calibrating, mirror, start);
    // Points do not tell the halves of the field apart, however far they are off.
    EXPECT_LT(by_plain.turn, 0.5 * kPi) << drive;
    EXPECT_LT(end.turn, 0.5 * kPi) << drive;
    EXPECT_LT(end.status == BeliefStatus::tracking ? end.error_m : 0.0, 0.1) << drive;
    plain_errors.push_back(by_plain.error_m);
    errors.push_back(end.error_m);
  }
  std::sort(plain_errors.begin(), plain_errors.end());
  std::sort(errors.begin(), errors.end());
  EXPECT_GT(plain_errors[kDrives / 2], 0.015);
  EXPECT_LT(errors[kDrives / 2], 0.01);
}

TEST(MirrorSelfCalibration, ABeliefIsWiderByWhatIsNotKnownOfTheMirror) {
  const auto plain = make_field_tracker(field_12x8(), {});
  const auto calibrating = make_field_tracker(field_12x8(), {}, soccer_rig());
  const Pose2 start{-2.0, -1.0, 0.3};
  end_of_drive(*plain, MirrorErrors::Zero(), start);
  end_of_drive(*calibrating, MirrorErrors::Zero(), start);
  EXPECT_GT(calibrating->belief().position_sigma(), 1.05 * plain->belief().position_sigma());
}

}  // namespace
}  // namespace vigia::localization
