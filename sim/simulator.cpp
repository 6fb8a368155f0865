#include "vigia/sim/simulator.hpp"

#include "true_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::sim {
namespace {

constexpr double kStill_px = 0.25;  // a smaller motion is not worth an average
constexpr double kNear_m = 1.5;     // what is nearer may blur in steps of more than a pixel

std::shared_ptr<const Appearance> appearance_of(const std::shared_ptr<const Appearance>& given,
                                                const WorldMap& world,
                                                const DisturbanceParams& disturbances,
                                                std::uint64_t seed) {
  if (!disturbances.clutter) return given;
  return std::make_shared<const Appearance>(
      true_appearance(given ? *given : Appearance{}, world, disturbances, seed));
}

/// How far the picture moves between two poses of the camera, px: the most of its middle and its
/// corners, of points at kNear_m and of points far away.
double motion_px(const Eigen::Isometry3d& aMb, const Intrinsics& k) {
  double most = 0.0;
  for (const double u : {0.0, 0.5, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      const Eigen::Vector3d ray((u * k.width - k.u0) / k.px, (v * k.height - k.v0) / k.py, 1.0);
      for (const double near : {1.0, 0.0}) {
        const Eigen::Vector3d p = aMb.linear() * ray + near / kNear_m * aMb.translation();
        if (p.z() <= 0.1) return std::numeric_limits<double>::infinity();
        most = std::max(most, k.px * (p.head<2>() / p.z() - ray.head<2>()).norm());
      }
    }
  }
  return most;
}

}  // namespace

Simulator::Simulator(const RobotSetup& setup, const WorldMap& world,
                     const std::shared_ptr<const Appearance>& appearance, const Pose2& start,
                     std::uint64_t seed, const DisturbanceParams& disturbances)
    : setup_(setup),
      world_(sim::true_world(world, disturbances, seed)),
      robot_(setup.robot, start, setup.initial_zoom_mm, derive_seed(seed, "robot"), world.ground),
      scene_(world_, appearance_of(appearance, world, disturbances, seed),
             derive_seed(seed, "scene")),
      camera_errors_(disturbances, seed),
      motion_blur_(disturbances.motion_blur) {
  robot_.set_zoom_range(setup_.zoom.min_zoom_mm(), setup_.zoom.max_zoom_mm());
  if (const auto rMr = camera_errors_.mounting(setup_.robot.head.mount_r))
    robot_.set_mounting_error(*rMr);
  if (disturbances.backlash) robot_.set_backlash(disturbances.backlash->width);
  if (disturbances.wheel_slip) robot_.set_wheel_slip(WheelSlip(*disturbances.wheel_slip, seed));
  if (disturbances.light) light_.emplace(*disturbances.light, world_.plan, seed);
  if (disturbances.people) walkers_.emplace(*disturbances.people, world_.plan, bystander(), seed);
  if (disturbances.kidnapping) kidnapping_.emplace(*disturbances.kidnapping, seed);
  if (disturbances.latency) {
    latency_ = Duration::from_seconds(disturbances.latency->latency_s);
    processing_ = Duration::from_seconds(disturbances.latency->processing_s);
  }
  if (setup_.range_ring) ring_.emplace(*setup_.range_ring, seed);
}

void Simulator::advance(Duration dt) {
  robot_.advance(dt);
  if (walkers_) walkers_->advance(dt.seconds(), bystander());
}

bool Simulator::kidnap() {
  if (!kidnapping_) return false;
  const RobotTruth& truth = robot_.truth();
  const auto pose = kidnapping_->due(truth.stamp, truth.pose, setup_.robot.radius_m, world_.plan,
                                     walkers_ ? &*walkers_ : nullptr);
  if (pose) robot_.kidnap(*pose);
  return pose.has_value();
}

Bystander Simulator::bystander() const {
  const RobotTruth& truth = robot_.truth();
  return {truth.pose.position(), truth.base.v * unit_vector(truth.pose.theta),
          setup_.robot.radius_m};
}

Intrinsics Simulator::true_intrinsics() const {
  const double zoom_mm = robot_.truth().zoom_mm;
  const double u = (zoom_mm - setup_.zoom.min_zoom_mm()) /
                   (setup_.zoom.max_zoom_mm() - setup_.zoom.min_zoom_mm());
  Intrinsics intrinsics = camera_errors_.true_intrinsics(setup_.zoom.at(zoom_mm), u);
  const double scale = std::exp(robot_.truth().look_log_focal_error);
  intrinsics.px *= scale;
  intrinsics.py *= scale;
  return intrinsics;
}

std::vector<Exposure::Instant> Simulator::instants(const Intrinsics& intrinsics) const {
  const std::vector<Person> people = walkers_ ? walkers_->people() : std::vector<Person>{};
  int count = 1;
  if (motion_blur_) {
    const double half = 0.5 * motion_blur_->exposure_s;
    const double moved = motion_px(
        robot_.camera_pose_after(half).inverse(Eigen::Isometry) * robot_.camera_pose_after(-half),
        intrinsics);
    if (moved > kStill_px)
      count =
          static_cast<int>(std::min<double>(motion_blur_->max_instants, 1.0 + std::ceil(moved)));
  }
  if (count == 1) return {{robot_.camera_pose(), people}};
  std::vector<Exposure::Instant> instants;
  for (int i = 0; i < count; ++i) {
    const double s = motion_blur_->exposure_s * ((i + 0.5) / count - 0.5);
    instants.push_back({robot_.camera_pose_after(s), people});
    for (Person& person : instants.back().people) person.position += person.velocity * s;
  }
  return instants;
}

std::unique_ptr<imaging::Frame> Simulator::expose() const {
  const Intrinsics intrinsics = true_intrinsics();
  Exposure exposure{instants(intrinsics), std::nullopt};
  if (light_) exposure.light = light_->at(robot_.truth().stamp);
  return scene_.expose(exposure, intrinsics, robot_.truth().stamp, setup_.imaging);
}

RangeScan Simulator::scan() {
  const RobotTruth& truth = robot_.truth();
  if (!ring_) return {truth.stamp, 0.0, {}};
  return ring_->scan(truth.stamp, truth.pose, world_.plan,
                     walkers_ ? walkers_->pillars() : std::vector<Pillar>{});
}

double Simulator::clearance() const {
  const double faces =
      world_.plan.clearance(robot_.truth().pose.position()) - setup_.robot.radius_m;
  return std::min(faces, clearance_of_people());
}

double Simulator::clearance_of_people() const {
  if (!walkers_) return std::numeric_limits<double>::infinity();
  return walkers_->clearance(robot_.truth().pose.position()) - setup_.robot.radius_m;
}

}  // namespace vigia::sim
