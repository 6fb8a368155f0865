#include "vigia/evaluation/ceiling_views.hpp"

#include "work_queue.hpp"

#include <cmath>
#include <utility>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/tracking/plane_flow.hpp"

namespace vigia::evaluation {
namespace {

constexpr double kRise_m = 2.2;
constexpr double kHallHalf_m = 500.0;

WorldMap hall_of(const CeilingSetting& setting) {
  const double h = kHallHalf_m;
  WorldMap world;
  world.name = "ceiling hall";
  world.plan = FloorPlan({{-h, -h}, {h, -h}, {h, h}, {-h, h}},
                         setting.camera_height_m + kRise_m * (1.0 + setting.height_error), {}, {});
  return world;
}

sim::Appearance look_of(const CeilingSetting& setting) {
  sim::Appearance look;
  look.contrast = setting.contrast;
  return look;
}

}  // namespace

CeilingSetting::CeilingSetting() {
  camera.px = camera.py = 0.5 * camera.width / std::tan(from_deg(30.0));
  ceiling.grid.height_m = camera_height_m + kRise_m;
}

localization::CeilingCamera CeilingSetting::known_camera() const {
  localization::CeilingCamera known;
  known.model = camera;
  known.rMc.translation() = Eigen::Vector3d(0.0, 0.0, camera_height_m);
  known.ceiling_m = camera_height_m + kRise_m;
  return known;
}

localization::CeilingCameraErrors CeilingSetting::true_errors() const {
  return {tilt * std::cos(tilt_axis), tilt * std::sin(tilt_axis), std::log(1.0 + height_error)};
}

tracking::PatchFinderParams CeilingSetting::finder() const {
  tracking::PatchFinderParams params;
  params.length_px = ceiling.grid.length_m / kRise_m * camera.px;
  params.width_px = ceiling.grid.width_m / kRise_m * camera.px;
  params.polarity = ceiling.grid.polarity;
  return params;
}

CeilingHall::CeilingHall(const CeilingSetting& setting)
    : setting_(setting),
      rMc_(localization::corrected(setting.known_camera(), setting.true_errors()).rMc),
      scene_(hall_of(setting), look_of(setting), setting.ceiling, setting.seed) {}

std::unique_ptr<imaging::Frame> CeilingHall::expose(const Pose2& pose, std::int64_t number) const {
  return scene_.expose(to_isometry(pose) * rMc_, setting_.camera, Stamp{number}, setting_.imaging);
}

std::vector<CeilingFrame> read_ceiling_drive(const CeilingSetting& setting,
                                             const std::vector<Pose2>& poses,
                                             const CeilingFlows& flows) {
  const CeilingHall hall(setting);
  const tracking::PatchFinder finder(setting.finder());
  const localization::CeilingCamera known = setting.known_camera();
  tracking::FrameFlow chain(known.model, known.rMc.linear());
  tracking::EdgeFlowParams window;
  window.max_shift_px = 3;
  window.max_turn = from_deg(0.9);
  window.turn_step = from_deg(0.15);
  std::optional<tracking::EdgeImage> edges;
  std::vector<CeilingFrame> frames;
  frames.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    CeilingFrame& frame = frames.emplace_back();
    frame.truth = poses[i];
    const auto exposure = hall.expose(poses[i], static_cast<std::int64_t>(i));
    if (!flows.published && !flows.by_key_frames) {
      frame.scan = finder.find(*exposure);
      continue;
    }
    const vpImage<unsigned char> image = imaging::grey_image(*exposure);
    frame.scan = finder.find(imaging::ImageFrame(image));
    if (flows.by_key_frames) {
      frame.flow = chain.next(image);
      frame.flow_agreement = chain.agreement();
    }
    if (!flows.published) continue;
    tracking::EdgeImage now = tracking::find_edges(image, window);
    if (edges) frame.edges = tracking::match_edges(*edges, now, window);
    edges = std::move(now);
  }
  return frames;
}

std::vector<std::vector<CeilingFrame>> read_ceiling_drives(const std::vector<CeilingDrive>& drives,
                                                           const CeilingFlows& flows, int threads) {
  std::vector<std::vector<CeilingFrame>> frames(drives.size());
  work_off(drives.size(), threads, [&](std::size_t i) {
    frames[i] = read_ceiling_drive(drives[i].setting, drives[i].poses, flows);
  });
  return frames;
}

std::vector<Pose2> straight_poses(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                  double step_m) {
  const Eigen::Vector2d way = to - from;
  const int steps = static_cast<int>(std::lround(way.norm() / step_m));
  std::vector<Pose2> poses;
  poses.reserve(static_cast<std::size_t>(steps) + 1);
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = from + (static_cast<double>(i) / steps) * way;
    poses.push_back({p.x(), p.y(), std::atan2(way.y(), way.x())});
  }
  return poses;
}

ImageShift image_shift(const localization::CeilingCamera& camera,
                       const tracking::EdgeMatch& match) {
  // (θ′, V′) = (−θ, −p R(θ)ᵀ V), p the size of a pixel.
  const double p = 1.0 / std::get<Intrinsics>(camera.model).px;
  ImageShift shift;
  shift.shift = -p * (Eigen::Rotation2Dd(-match.turn) * match.shift_px);
  shift.turn = -match.turn;
  // Rounded to whole pixels and to the window's steps.
  shift.covariance = Eigen::Vector3d(p * p / 12.0, p * p / 12.0, 1e-6).asDiagonal();
  return shift;
}

Pose2 published_motion(const localization::CeilingCamera& camera,
                       const tracking::EdgeMatch& match) {
  return localization::robot_motion(camera, image_shift(camera, match));
}

}  // namespace vigia::evaluation
