#include "synthetic_drive.hpp"

#include <cmath>

namespace vigia::report::test {
namespace {

constexpr double kStep_m = 0.02;

Landmark disc(LandmarkId id, double x, double y, double normal_yaw) {
  return {id, wall_mount({x, y, 1.6}, normal_yaw), DiscShape{0.1}};
}

Obstacle box(double x, double y, double width, double depth) {
  return {{{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}}, 1.0};
}

// Grows while nothing is seen and shrinks at a look.
double sigma_at(double since_look_m) {
  return 0.012 + 0.02 * since_look_m;
}

}  // namespace

WorldMap synthetic_world() {
  WorldMap world;
  world.name = "synthetic room";
  world.plan = FloorPlan(
      {{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8, {{{6.0, 7.0}, {6.0, 5.4}, 2.8}},
      {box(4.0, 2.9, 3.6, 1.1), box(10.6, 0.4, 1.0, 1.0), box(0.2, 5.4, 1.4, 0.8)});
  world.landmarks =
      LandmarkMap({disc(0, 3.0, 0.0, M_PI_2), disc(1, 9.0, 0.0, M_PI_2), disc(2, 12.0, 3.5, M_PI),
                   disc(3, 9.0, 7.0, -M_PI_2), disc(4, 3.0, 7.0, -M_PI_2), disc(6, 0.0, 3.5, 0.0)});
  return world;
}

MapDrive synthetic_drive(const WorldMap& world) {
  MapDrive drive{world};
  drive.title = "Armingol's room, seed 1";
  drive.subtitle = "nearest policy · 0.3° a look · 22.4 m in 78 s · arrived";
  drive.estimate_name = "EKF";
  drive.footer = "made input of a test: not the result of a mission";
  drive.planned = Path({{1.2, 1.2},
                        {9.6, 1.4},
                        {10.8, 3.0},
                        {9.8, 4.9},
                        {7.0, 4.7},
                        {2.4, 4.8},
                        {1.2, 3.4},
                        {1.6, 1.9}});
  double since_look = 0.0;
  LandmarkId next = 0;
  for (double s = 0.0; s <= drive.planned.length(); s += kStep_m) {
    const Eigen::Vector2d p = drive.planned.at(s);
    const double heading = drive.planned.heading(s);
    const Pose2 truth{p.x() + 0.03 * std::sin(1.3 * s), p.y() + 0.03 * std::cos(0.9 * s), heading};
    const double sigma = sigma_at(since_look);
    MapPose estimate;
    estimate.pose = {truth.x + 0.9 * sigma * std::sin(2.1 * s), truth.y + sigma * std::cos(1.7 * s),
                     heading};
    estimate.covariance = Eigen::Vector3d(sigma * sigma, 0.3 * sigma * sigma, 1e-4).asDiagonal();
    estimate.covariance(0, 1) = estimate.covariance(1, 0) = 0.3 * sigma * sigma;
    drive.truth.push_back(truth);
    drive.estimate.push_back(estimate);
    drive.odometry.push_back({truth.x + 0.0006 * s * s, truth.y - 0.012 * s, heading});
    since_look += kStep_m;
    if (since_look < 1.0) continue;
    since_look = 0.0;
    drive.looks.push_back({next, truth.position(), next != 3});
    next = next == 4 ? 6 : (next + 1) % 7;
  }
  return drive;
}

}  // namespace vigia::report::test
