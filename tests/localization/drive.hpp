#pragma once

#include "localization/room.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "vigia/core/odometry.hpp"
#include "vigia/localization/localizer.hpp"

namespace vigia::localization::test {

/// One step of a simulated drive at the level of measurements.
struct DriveStep {
  OdometryIncrement truth;
  OdometryIncrement measured;
  Pose2 pose;  ///< true, after the step
  LookBias bias;
  std::optional<EllipseObservation> seen;  ///< at the step's end
};

struct DriveNoise {
  OdometryNoise odometry{0.01, 0.012, 0.01};  ///< about 20 cm and 3.5° in 22 m
  SensorNoise sensor;
  double pixel_sigma = 0.05;
};

struct Drive {
  Pose2 start;
  Prior prior;
  HeadGeometry geometry;
  DriveNoise noise;
  std::vector<DriveStep> steps;
};

constexpr double kTick = 0.04;  // s

/// Rates (v, w) of a loop of 17 m through the gap of the room's partitions, one entry a tick.
inline std::vector<std::pair<double, double>> loop_rates() {
  std::vector<std::pair<double, double>> rates;
  const auto run = [&rates](double metres, double turn) {
    const auto ticks = static_cast<int>(std::lround(metres / 0.3 / kTick));
    for (int i = 0; i < ticks; ++i) rates.emplace_back(0.3, turn / (ticks * kTick));
  };
  for (const double straight : {5.8, 0.8, 5.8, 0.8}) {
    run(straight, 0.0);
    run(0.94, 0.5 * kPi);  // radius 0.6 m
  }
  return rates;
}

/// The landmark nearest to the robot that it sees, at less than 65° from the normal.
inline const Landmark* nearest_visible(const LandmarkMap& map, const FloorPlan& plan,
                                       const Pose2& pose, const HeadGeometry& geometry) {
  const Landmark* nearest = nullptr;
  double least = 9.0;
  const Eigen::Vector3d eye = to_isometry(pose) * geometry.mount_r;
  for (const Landmark& landmark : map.all()) {
    const Eigen::Vector3d line = eye - landmark.centre_w();
    if (line.normalized().dot(landmark.normal_w()) < std::cos(from_deg(65.0))) continue;
    if (line.norm() >= least || !plan.line_of_sight(eye, landmark.centre_w())) continue;
    least = line.norm();
    nearest = &landmark;
  }
  return nearest;
}

/// A drive along loop_rates() with a look of one second about every metre, noise drawn from the
/// model that the filter is told.
inline Drive simulate_drive(const DriveNoise& noise, std::uint64_t seed) {
  RandomStream odometry(seed, "odometry");
  RandomStream sensor(seed, "sensor");
  const LandmarkMap map = room_landmarks();
  const FloorPlan plan = room_plan();
  Drive drive;
  drive.noise = noise;
  drive.start = {2.6, 2.6, 0.0};
  const Eigen::Vector3d sigma(0.02, 0.02, from_deg(0.5));
  drive.prior.covariance = sigma.cwiseAbs2().asDiagonal();
  drive.prior.pose = {drive.start.x + sigma.x() * odometry.normal(),
                      drive.start.y + sigma.y() * odometry.normal(),
                      drive.start.theta + sigma.z() * odometry.normal()};

  constexpr int kPeriod = 83;  // ticks between looks: a metre
  constexpr int kDwell = 25;
  Pose2 pose = drive.start;
  const Landmark* landmark = nullptr;
  DriveStep step;
  int tick = 0;
  for (const auto& [v, w] : loop_rates()) {
    const Stamp from = Stamp::from_seconds(tick * kTick);
    const Stamp to = Stamp::from_seconds((tick + 1) * kTick);
    step.truth = arc_increment(v, w, from, to);
    step.measured = step.truth;
    const Eigen::Matrix3d control = control_covariance(step.truth, noise.odometry);
    step.measured.rot1 += std::sqrt(control(0, 0)) * odometry.normal();
    step.measured.trans += std::sqrt(control(1, 1)) * odometry.normal();
    step.measured.rot2 += std::sqrt(control(2, 2)) * odometry.normal();
    pose = move(pose, step.truth);
    step.pose = pose;
    step.seen.reset();
    const int phase = tick % kPeriod;
    if (phase == 0) {
      landmark = nearest_visible(map, plan, pose, drive.geometry);
      step.bias = draw_bias(sensor, noise.sensor);
    }
    if (phase < kDwell && landmark != nullptr) {
      const Shot shot =
          aimed_shot(*landmark, drive.geometry, pose, step.bias, 1 + tick / kPeriod, to);
      step.seen = observe(*landmark, shot, drive.geometry, pose, step.bias,
                          noise.sensor.reading_angle, noise.pixel_sigma, sensor);
    }
    drive.steps.push_back(step);
    ++tick;
  }
  return drive;
}

}  // namespace vigia::localization::test
