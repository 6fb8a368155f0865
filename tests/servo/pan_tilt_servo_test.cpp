#include "vigia/servo/pan_tilt_servo.hpp"

#include "head_bench.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"
#include "vigia/servo/base_motion.hpp"

namespace vigia::servo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

HeadGeometry offset_head() {
  HeadGeometry geometry;
  geometry.mount_r = {0.15, 0.02, 1.0};
  geometry.mount_yaw = 0.1;
  geometry.camera_offset_h = {0.04, 0.01, 0.03};
  return geometry;
}

/// A point at a given pixel and depth, in the base frame.
Vector3d point_at(const HeadGeometry& geometry, const HeadAngles& head, const Vector3d& p_c) {
  return camera_in_base(geometry, head) * p_c;
}

/// The undistorted image of a base-frame point after the head and the base moved for dt.
Vector2d image_after(const HeadGeometry& geometry, const Vector3d& p_r, HeadAngles head,
                     const HeadAngles& rates, const BaseRates& base, double dt) {
  head.pan += dt * rates.pan;
  head.tilt += dt * rates.tilt;
  const Pose2 moved{base.v * dt, 0.0, base.w * dt};
  const Vector3d p_c = (to_isometry(moved) * camera_in_base(geometry, head)).inverse() * p_r;
  return {p_c.x() / p_c.z(), p_c.y() / p_c.z()};
}

const std::vector<HeadAngles> kHeads{{0.0, 0.0}, {1.2, 0.3}, {-2.5, -0.4}, {3.0, 0.9}};
const std::vector<Vector3d> kPoints{{0.0, 0.0, 3.0}, {0.4, -0.2, 1.5}, {-0.6, 0.5, 4.0}};

TEST(PanTiltServo, MakesTheImageErrorDecayAtItsGainByFiniteDifferences) {
  const HeadGeometry geometry = offset_head();
  const PanTiltServo servo(geometry, {4.0, true, 0.0});
  const Intrinsics camera = test_zoom().at(8.0);
  const BaseRates base{0.3, -0.5};
  const double dt = 1e-6;
  for (const HeadAngles& head : kHeads) {
    for (const Vector3d& p_c : kPoints) {
      const Vector3d p_r = point_at(geometry, head, p_c);
      const auto uv = project(camera, p_c);
      ASSERT_TRUE(uv);
      const HeadAngles rates = servo.rates(camera, *uv, p_c.z(), head, base);
      const Vector2d now = image_after(geometry, p_r, head, rates, base, 0.0);
      const Vector2d before = image_after(geometry, p_r, head, rates, base, -dt);
      const Vector2d after = image_after(geometry, p_r, head, rates, base, dt);
      const Vector2d velocity = (after - before) / (2.0 * dt);
      EXPECT_NEAR((velocity + 4.0 * now).norm(), 0.0, 1e-7);
    }
  }
}

TEST(PanTiltServo, CompensationKeepsAPointsImageByFiniteDifferences) {
  const HeadGeometry geometry = offset_head();
  const PanTiltServo servo(geometry, {4.0, true, 0.0});
  const double dt = 1e-6;
  for (const BaseRates& base : {BaseRates{0.3, 0.0}, BaseRates{0.0, 0.8}, BaseRates{0.2, -0.4}}) {
    for (const HeadAngles& head : kHeads) {
      for (const Vector3d& p_c : kPoints) {
        const Vector3d p_r = point_at(geometry, head, p_c);
        const HeadAngles rates = servo.compensation(p_c, head, base);
        const Vector2d before = image_after(geometry, p_r, head, rates, base, -dt);
        const Vector2d after = image_after(geometry, p_r, head, rates, base, dt);
        EXPECT_NEAR((after - before).norm() / (2.0 * dt), 0.0, 1e-7);
      }
    }
  }
}

TEST(PanTiltServo, AHeldCommandKeepsTheImageToThirdOrderInTheTick) {
  // The error of holding the rate of the interval's middle falls with the cube of the tick, that of
  // holding the rate of its beginning with the square.
  const HeadGeometry geometry = offset_head();
  const HeadAngles head{1.2, 0.3};
  const Vector3d p_c{0.1, -0.1, 1.5};
  const Vector3d p_r = point_at(geometry, head, p_c);
  const BaseRates base{0.3, 0.5};
  const Vector2d image = p_c.head<2>() / p_c.z();
  const auto drift = [&](double tick, bool middle) {
    const PanTiltServo servo(geometry, {4.0, true, middle ? tick : 0.0});
    HeadAngles after = head;
    const HeadAngles rates = servo.compensation(p_c, head, base);
    after.pan += tick * rates.pan;
    after.tilt += tick * rates.tilt;
    const Pose2 moved =
        move(Pose2{}, arc_increment(base.v, base.w, Stamp{}, Stamp::from_seconds(tick)));
    const Vector3d q_c = (to_isometry(moved) * camera_in_base(geometry, after)).inverse() * p_r;
    return (Vector2d(q_c.x() / q_c.z(), q_c.y() / q_c.z()) - image).norm();
  };
  EXPECT_GT(drift(0.08, true) / drift(0.04, true), 6.5);
  EXPECT_LT(drift(0.08, false) / drift(0.04, false), 4.5);
  EXPECT_LT(drift(0.04, true), 0.05 * drift(0.04, false));
}

TEST(PanTiltServo, AsksForNothingWhenTheTargetIsCentredAndTheBaseRests) {
  const PanTiltServo servo(HeadGeometry{}, {});
  const Intrinsics camera = test_zoom().at(8.0);
  const HeadAngles rates = servo.rates(camera, {camera.u0, camera.v0}, 3.0, {0.3, 0.2}, {});
  EXPECT_NEAR(rates.pan, 0.0, 1e-15);
  EXPECT_NEAR(rates.tilt, 0.0, 1e-15);
}

// A drive past a landmark with the servo closed over it, at 25 Hz and f = 700 px.
struct Drive {
  BaseRates command;
  Vector3d landmark_w;
};

enum class BaseKnowledge { none, noisy_odometry, odometry_and_command };

/// rms of the landmark's distance from the principal point, px, from one second on.
double centring_rms(const Drive& drive, PanTiltServoParams params, BaseKnowledge knowledge) {
  HeadBench bench;
  bench.pose = {0.0, 0.0, 0.0};
  params.feed_forward = knowledge != BaseKnowledge::none;
  const PanTiltServo servo(bench.geometry, params);
  BaseMotion motion({bench.base_limits, bench.tick_s});
  RandomStream noise(1, "servo test");
  bench.head.angles = aim_at(bench.geometry, drive.landmark_w);
  const OdometryNoise odometry_noise;
  double sum = 0.0;
  int count = 0;
  Pose2 last = bench.pose;
  for (int tick = 0; tick < 200; ++tick) {
    const auto uv = bench.pixel(drive.landmark_w);
    if (!uv) return 1e9;
    const Intrinsics camera = bench.intrinsics();
    const double error = (*uv - Vector2d(camera.u0, camera.v0)).norm();
    if (bench.now.seconds() >= 1.0) {
      sum += error * error;
      ++count;
    }
    const double metres = (bench.pose.position() - last.position()).norm();
    const double radians = wrap_angle(bench.pose.theta - last.theta);
    last = bench.pose;
    BaseRates odometry{
        (metres + odometry_noise.trans_per_sqrt_m * std::sqrt(metres) * noise.normal()) /
            bench.tick_s,
        (radians + std::hypot(odometry_noise.rot_per_sqrt_m * std::sqrt(metres),
                              odometry_noise.rot_per_sqrt_rad * std::sqrt(std::abs(radians))) *
                       noise.normal()) /
            bench.tick_s};
    const BaseRates foreseen = motion.expect(odometry, drive.command);
    const Vector2d measured = *uv + 0.01 * Vector2d(noise.normal(), noise.normal());
    HeadRates rates;
    rates.angles =
        servo.rates(camera, measured, bench.in_camera(drive.landmark_w).z(), bench.head.angles,
                    knowledge == BaseKnowledge::odometry_and_command ? foreseen : odometry);
    bench.advance(drive.command, rates);
  }
  return std::sqrt(sum / count);
}

/// Past landmarks at 1.5–4 m, straight and on arcs.
std::vector<Drive> drives() {
  std::vector<Drive> result;
  for (const double side : {1.5, 2.5, 4.0}) {
    for (const double w : {0.0, 0.15, -0.15}) result.push_back({{0.3, w}, {1.5, side, 1.6}});
  }
  return result;
}

double worst_rms(const PanTiltServoParams& params, BaseKnowledge knowledge) {
  double worst = 0.0;
  for (const Drive& drive : drives())
    worst = std::max(worst, centring_rms(drive, params, knowledge));
  return worst;
}

TEST(PanTiltServo, CentresWithinHalfAPixelWhileDriving) {
  const double rms = worst_rms({}, BaseKnowledge::odometry_and_command);
  RecordProperty("centring_rms_px", std::to_string(rms));
  EXPECT_LE(rms, 0.5);
}

TEST(PanTiltServo, WithoutFeedForwardTheTargetLagsByTensOfPixels) {
  const double rms = worst_rms({}, BaseKnowledge::none);
  RecordProperty("centring_rms_px", std::to_string(rms));
  EXPECT_GT(rms, 20.0);
}

TEST(PanTiltServo, NoisyOdometryAloneCostsMoreThanTheForeseenMotion) {
  const double odometry = worst_rms({}, BaseKnowledge::noisy_odometry);
  RecordProperty("centring_rms_px", std::to_string(odometry));
  EXPECT_GT(odometry, worst_rms({}, BaseKnowledge::odometry_and_command));
}

TEST(PanTiltServo, TheMiddleOfTheTickCentresBetterThanItsBeginning) {
  PanTiltServoParams beginning;
  beginning.hold_s = 0.0;
  const double rms = worst_rms(beginning, BaseKnowledge::odometry_and_command);
  RecordProperty("centring_rms_px", std::to_string(rms));
  EXPECT_LT(worst_rms({}, BaseKnowledge::odometry_and_command), rms);
}

}  // namespace
}  // namespace vigia::servo
