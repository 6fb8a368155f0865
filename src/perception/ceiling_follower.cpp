#include "vigia/perception/ceiling_follower.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "vigia/core/angle.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::perception {
namespace {

constexpr double kStartSigma_m = 0.05;
constexpr double kStartTurn = from_deg(4.0);
constexpr double kTiltFloor = from_deg(0.005);

localization::CeilingCamera camera_under(const CeilingView& view) {
  localization::CeilingCamera camera;
  camera.model = view.camera;
  camera.ceiling_m = view.rise_m;
  return camera;
}

localization::CeilingFilterParams filter_params_of(const CeilingView& view) {
  localization::CeilingFilterParams params;
  params.tilt_sigma = view.tilt_sigma;
  params.height_sigma = view.height_sigma;
  params.max_speed_mps = view.max_speed_mps;
  return params;
}

}  // namespace

tracking::PatchFinderParams finder_of(const CeilingView& view) {
  tracking::PatchFinderParams params;
  params.length_px = view.grid.length_m / view.rise_m * view.camera.px;
  params.width_px = view.grid.width_m / view.rise_m * view.camera.px;
  params.polarity = view.grid.polarity;
  params.scale_sigma = std::max(params.scale_sigma, view.height_sigma);
  return params;
}

CeilingFollower::CeilingFollower(const CeilingView& view,
                                 const localization::CeilingCameraErrors& about)
    : camera_(camera_under(view)),
      grid_(view.grid),
      about_(about),
      finder_(finder_of(view)),
      flow_(camera_.model, camera_.rMc.linear()),
      filter_(camera_, view.grid, filter_params_of(view)),
      start_tilt_m_(view.rise_m * std::tan(view.tilt_sigma)) {}

/// Where the camera is if the patch nearest to the picture's middle is that of the cell (0, 0).
bool CeilingFollower::begin(const tracking::PatchScan& scan, Stamp stamp) {
  const Intrinsics& camera = std::get<Intrinsics>(camera_.model);
  const Eigen::Vector2d middle(camera.u0, camera.v0);
  const auto off = [&](const PatchImage& patch) { return (patch.uv - middle).norm(); };
  const auto nearest =
      std::min_element(scan.patches.begin(), scan.patches.end(),
                       [&](const auto& a, const auto& b) { return off(a) < off(b); });
  if (nearest == scan.patches.end()) return false;
  const auto patch = localization::on_ceiling(camera_, *nearest, about_);
  if (!patch) return false;
  Pose2 pose;
  pose.theta = wrap_angle(-patch->psi);
  if (!grid_.polarity && std::abs(pose.theta) > 0.5 * kPi)
    pose.theta = wrap_angle(pose.theta + kPi);
  const Eigen::Vector2d p = cell_centre(grid_, {0, 0}) - Eigen::Rotation2Dd(pose.theta) * patch->q;
  pose.x = p.x();
  pose.y = p.y();
  const double sigma_m = kStartSigma_m + start_tilt_m_;
  const Eigen::Vector3d sigma(sigma_m, sigma_m, kStartTurn);
  filter_.reset(stamp, {pose, sigma.cwiseAbs2().asDiagonal()}, about_);
  return true;
}

CeilingFollower::Sight CeilingFollower::look(const vpImage<unsigned char>& picture, Stamp stamp) {
  return {stamp, finder_.find(imaging::ImageFrame(picture)), flow_.next(picture)};
}

CeilingFollower::Step CeilingFollower::follow(const Sight& sight) {
  Step step{sight.scan, sight.motion.has_value(), std::nullopt};
  if (!begun_) {
    begun_ = begin(step.scan, sight.stamp);
    if (!begun_) return step;
  } else if (sight.motion) {
    filter_.predict(*sight.motion, sight.stamp);
  } else {
    filter_.predict_unknown(sight.stamp);
  }
  step.update = filter_.update(step.scan.patches);
  return step;
}

Eigen::Matrix3d CeilingFollower::camera_errors_covariance() const {
  Eigen::Matrix3d P = filter_.camera_errors_covariance();
  P.diagonal().head<2>().array() += kTiltFloor * kTiltFloor;
  return P;
}

std::optional<Belief> CeilingFollower::belief() const {
  if (!begun_) return std::nullopt;
  return filter_.belief();
}

}  // namespace vigia::perception
