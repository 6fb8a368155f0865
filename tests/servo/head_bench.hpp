#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "vigia/core/actuation.hpp"
#include "vigia/core/camera.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/servo/gaze_controller.hpp"

namespace vigia::servo {

inline ZoomCalibration test_zoom() {
  return ZoomCalibration(640, 480, 319.5, 239.5, {{8.0, 700.0, 0.05}, {48.0, 4200.0, 0.01}});
}

/// A base that runs at exact rates with a head under limits of rate and acceleration: what the
/// servo is closed over in the tests. Kinematics alone, integrated in steps of a millisecond.
struct HeadBench {
  HeadGeometry geometry;
  HeadLimits limits;
  BaseLimits base_limits;
  ZoomCalibration zoom = test_zoom();
  Pose2 pose;
  BaseRates base;
  HeadReading head;
  Stamp now;
  double tick_s = 0.04;

  Intrinsics intrinsics() const { return zoom.at(head.zoom_mm); }

  Eigen::Vector3d in_camera(const Eigen::Vector3d& p_w) const {
    return (to_isometry(pose) * camera_in_base(geometry, head.angles)).inverse() * p_w;
  }
  std::optional<Eigen::Vector2d> pixel(const Eigen::Vector3d& p_w) const {
    return project(intrinsics(), in_camera(p_w));
  }

  static double ramped(double rate, double command, double acceleration, double dt) {
    return rate + std::clamp(command - rate, -acceleration * dt, acceleration * dt);
  }

  void advance(const BaseRates& base_command, const HeadRates& command) {
    constexpr double kStep = 1e-3;
    const auto steps = std::lround(tick_s / kStep);
    for (long i = 0; i < steps; ++i) {
      base.v = ramped(base.v, base_command.v, base_limits.acceleration, kStep);
      base.w = ramped(base.w, base_command.w, base_limits.turn_acceleration, kStep);
      pose = move(pose, arc_increment(base.v, base.w, Stamp{}, Stamp::from_seconds(kStep)));
      turn(head.angles.pan, head.rates.pan, command.angles.pan, limits.pan_min, limits.pan_max);
      turn(head.angles.tilt, head.rates.tilt, command.angles.tilt, limits.tilt_min,
           limits.tilt_max);
      const double zoom_rate =
          std::clamp(command.zoom_mm_s, -limits.zoom_rate_mm_s, limits.zoom_rate_mm_s);
      head.zoom_mm =
          std::clamp(head.zoom_mm + kStep * zoom_rate, zoom.min_zoom_mm(), zoom.max_zoom_mm());
    }
    now = now + Duration::from_seconds(tick_s);
  }

 private:
  void turn(double& angle, double& rate, double command, double low, double high) const {
    constexpr double kStep = 1e-3;
    const double wanted = std::clamp(command, -limits.rate, limits.rate);
    const double next = ramped(rate, wanted, limits.acceleration, kStep);
    angle += 0.5 * (rate + next) * kStep;
    rate = next;
    if (angle < low || angle > high) {
      angle = std::clamp(angle, low, high);
      rate = 0.0;
    }
  }
};

}  // namespace vigia::servo
