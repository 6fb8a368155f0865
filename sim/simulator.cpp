#include "vigia/sim/simulator.hpp"

#include "true_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

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

/// How far the picture moves between two poses of the camera, px: the largest of its middle and its
/// corners, of points at kNear_m and of points far away.
double motion_px(const Eigen::Isometry3d& aMb, const Intrinsics& k) {
  double largest = 0.0;
  for (const double u : {0.0, 0.5, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      const Eigen::Vector3d ray((u * k.width - k.u0) / k.px, (v * k.height - k.v0) / k.py, 1.0);
      for (const double near : {1.0, 0.0}) {
        const Eigen::Vector3d p = aMb.linear() * ray + near / kNear_m * aMb.translation();
        if (p.z() <= 0.1) return std::numeric_limits<double>::infinity();
        largest = std::max(largest, k.px * (p.head<2>() / p.z() - ray.head<2>()).norm());
      }
    }
  }
  return largest;
}

/// The same, of directions all round that the mirror shows from both poses.
double motion_px(const Eigen::Isometry3d& aMb, const UnifiedOmni& omni) {
  const CameraModel model = omni;
  double largest = 0.0;
  for (const double off_axis : {0.3, 0.6, 0.9}) {
    for (int i = 0; i < 8; ++i) {
      const double angle = off_axis * omni.max_angle;
      const double azimuth = 0.25 * kPi * i;
      const Eigen::Vector3d ray(std::sin(angle) * std::cos(azimuth),
                                std::sin(angle) * std::sin(azimuth), std::cos(angle));
      const auto from = project(model, ray);
      for (const double near : {1.0, 0.0}) {
        const auto to = project(
            model, Eigen::Vector3d(aMb.linear() * ray + near / kNear_m * aMb.translation()));
        if (from && to) largest = std::max(largest, (*to - *from).norm());
      }
    }
  }
  return largest;
}

}  // namespace

Simulator::Simulator(const RobotSetup& setup, const WorldMap& world,
                     const std::shared_ptr<const Appearance>& appearance, const Pose2& start,
                     std::uint64_t seed, const DisturbanceParams& disturbances)
    : setup_(setup),
      world_(sim::true_world(world, disturbances, seed)),
      robot_(setup.robot, start, setup.initial_zoom_mm, derive_seed(seed, "robot"), world_.ground),
      scene_(world_, appearance_of(appearance, world, disturbances, seed),
             derive_seed(seed, "scene")),
      motion_blur_(disturbances.motion_blur) {
  if (setup_.directed_camera() != nullptr)
    robot_.set_zoom_range(setup_.zoom().min_zoom_mm(), setup_.zoom().max_zoom_mm());
  robot_.set_camera(setup_.cameras.front().camera.mount);
  const auto pair = stereo_cameras(setup_.rig());
  for (const CameraSetup& camera : setup_.cameras) {
    CameraErrors errors(disturbances, seed, camera.camera.id);
    if (pair && disturbances.stereo)
      errors.draw_pair(*disturbances.stereo, seed, camera.camera.id == pair->left ? 1.0 : -1.0);
    cameras_.push_back({camera, errors, errors.true_mount(camera.camera)});
  }
  disturb(disturbances, seed);
  if (setup_.range_ring) ring_.emplace(*setup_.range_ring, seed);
}

void Simulator::disturb(const DisturbanceParams& disturbances, std::uint64_t seed) {
  if (const auto rMr = CameraErrors(disturbances, seed).mounting(setup_.robot.head.mount_r))
    robot_.set_mounting_error(*rMr);
  if (disturbances.backlash) robot_.set_backlash(disturbances.backlash->width);
  if (disturbances.wheel_slip) robot_.set_wheel_slip(WheelSlip(*disturbances.wheel_slip, seed));
  if (disturbances.light) light_.emplace(*disturbances.light, world_.plan, seed, world_.ground);
  if (disturbances.people) walkers_.emplace(*disturbances.people, world_.plan, bystander(), seed);
  if (disturbances.kidnapping) kidnapping_.emplace(*disturbances.kidnapping, seed);
  if (disturbances.latency) {
    latency_ = Duration::from_seconds(disturbances.latency->latency_s);
    processing_ = Duration::from_seconds(disturbances.latency->processing_s);
  }
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
  const Eigen::Vector2d ahead = unit_vector(truth.pose.theta);
  return {truth.pose.position(),
          truth.base.v * ahead + truth.base.vy * Eigen::Vector2d(-ahead.y(), ahead.x()),
          setup_.robot.radius_m};
}

const Simulator::TrueCamera& Simulator::camera_of(CameraId id) const {
  const auto found = std::find_if(cameras_.begin(), cameras_.end(), [id](const TrueCamera& camera) {
    return camera.setup.camera.id == id;
  });
  if (found == cameras_.end())
    throw std::out_of_range("the robot has no camera " + std::to_string(id));
  return *found;
}

CameraModel Simulator::true_model(CameraId camera) const {
  const TrueCamera& truth = camera_of(camera);
  if (const auto* fixed = std::get_if<CameraModel>(&truth.setup.camera.optics))
    return truth.errors.true_model(*fixed);
  const auto& zoom = std::get<ZoomCalibration>(truth.setup.camera.optics);
  const double zoom_mm = robot_.truth().zoom_mm;
  const double u = (zoom_mm - zoom.min_zoom_mm()) / (zoom.max_zoom_mm() - zoom.min_zoom_mm());
  Intrinsics intrinsics = truth.errors.true_intrinsics(zoom.at(zoom_mm), u);
  const double scale = std::exp(robot_.truth().look_log_focal_error);
  intrinsics.px *= scale;
  intrinsics.py *= scale;
  return intrinsics;
}

/// From plan coordinates to where they stand in the world.
std::vector<Person> Simulator::figures() const {
  std::vector<Person> figures = figures_in_plan();
  for (Person& figure : figures) {
    const Eigen::Vector3d foot_w = world_.ground.lift(figure.position, 0.0);
    figure.position = foot_w.head<2>();
    figure.floor_m = foot_w.z();
  }
  return figures;
}

std::vector<Person> Simulator::figures_in_plan() const {
  std::vector<Person> figures = walkers_ ? walkers_->people() : std::vector<Person>{};
  if (setup_.robot.body_height_m <= 0.0) return figures;
  const Bystander robot = bystander();
  Person& own = figures.emplace_back();
  own.figure = Figure::chassis;
  own.position = robot.position;
  own.velocity = robot.velocity;
  own.heading = robot_.truth().pose.theta;
  own.radius_m = robot.radius_m;
  own.height_m = setup_.robot.body_height_m;
  return figures;
}

std::vector<Exposure::Instant> Simulator::instants(const TrueCamera& camera,
                                                   const CameraModel& model) const {
  const std::vector<Person> people = figures();
  int count = 1;
  if (motion_blur_) {
    const double half = 0.5 * motion_blur_->exposure_s;
    const Eigen::Isometry3d moved =
        robot_.camera_pose_after(camera.mount, half).inverse(Eigen::Isometry) *
        robot_.camera_pose_after(camera.mount, -half);
    const double moved_px = std::visit([&](const auto& m) { return motion_px(moved, m); }, model);
    if (moved_px > kStill_px)
      count =
          static_cast<int>(std::min<double>(motion_blur_->max_instants, 1.0 + std::ceil(moved_px)));
  }
  if (count == 1) return {{robot_.camera_pose(camera.mount), people}};
  std::vector<Exposure::Instant> instants;
  for (int i = 0; i < count; ++i) {
    const double s = motion_blur_->exposure_s * ((i + 0.5) / count - 0.5);
    instants.push_back({robot_.camera_pose_after(camera.mount, s), people});
    for (Person& person : instants.back().people) person.position += person.velocity * s;
  }
  return instants;
}

std::unique_ptr<imaging::Frame> Simulator::expose(CameraId camera) const {
  const TrueCamera& truth = camera_of(camera);
  const CameraModel model = true_model(camera);
  Exposure exposure{instants(truth, model), std::nullopt};
  if (light_) exposure.light = light_->at(robot_.truth().stamp);
  return scene_.expose(exposure, model, robot_.truth().stamp, truth.setup.imaging, camera);
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
