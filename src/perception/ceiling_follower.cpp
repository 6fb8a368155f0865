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
constexpr double kSameDirection = from_deg(8.0);
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

/// Where the camera is if a patch is that of the cell (0, 0).
std::optional<Pose2> CeilingFollower::placed_by(const PatchImage& image) const {
  const auto patch = localization::on_ceiling(camera_, image, about_);
  if (!patch) return std::nullopt;
  Pose2 pose;
  pose.theta = wrap_angle(-patch->psi);
  if (!grid_.polarity && std::abs(pose.theta) > 0.5 * kPi)
    pose.theta = wrap_angle(pose.theta + kPi);
  const Eigen::Vector2d p = cell_centre(grid_, {0, 0}) - Eigen::Rotation2Dd(pose.theta) * patch->q;
  pose.x = p.x();
  pose.y = p.y();
  return pose;
}

/// How many patches lie on the grid as seen from a pose.
int CeilingFollower::agreeing(const std::vector<PatchImage>& patches, const Pose2& pose) const {
  int count = 0;
  for (const PatchImage& image : patches) {
    const auto patch = localization::on_ceiling(camera_, image, about_);
    if (!patch) continue;
    const Eigen::Vector2d p = pose.position() + Eigen::Rotation2Dd(pose.theta) * patch->q;
    const double off = (cell_centre(grid_, nearest_cell(grid_, p)) - p).norm();
    double turn = std::abs(wrap_angle(patch->psi + pose.theta));
    if (!grid_.polarity) turn = std::min(turn, kPi - turn);
    const bool lies = off < 0.15 * grid_.pitch_m + 4.0 * grid_.placement_m;
    if (lies && turn < kSameDirection + 4.0 * grid_.placement_turn) ++count;
  }
  return count;
}

/// By the patch with which most agree, of several the one nearest to the picture's middle: one that
/// is none of the grid's would lay the grid through itself.
bool CeilingFollower::begin(const tracking::PatchScan& scan, Stamp stamp) {
  const Intrinsics& camera = std::get<Intrinsics>(camera_.model);
  const Eigen::Vector2d middle(camera.u0, camera.v0);
  std::optional<Pose2> best;
  int most = 0;
  double nearest_px = 0.0;
  for (const PatchImage& image : scan.patches) {
    const auto pose = placed_by(image);
    if (!pose) continue;
    const int agree = agreeing(scan.patches, *pose);
    const double off_px = (image.uv - middle).norm();
    if (best && (agree < most || (agree == most && off_px > nearest_px))) continue;
    best = pose;
    most = agree;
    nearest_px = off_px;
  }
  if (!best) return false;
  const double sigma_m = kStartSigma_m + start_tilt_m_;
  const Eigen::Vector3d sigma(sigma_m, sigma_m, kStartTurn);
  filter_.reset(stamp, {*best, sigma.cwiseAbs2().asDiagonal()}, about_);
  return true;
}

CeilingFollower::Sight CeilingFollower::look(const vpImage<unsigned char>& picture, Stamp stamp) {
  return {stamp, finder_.find(imaging::ImageFrame(picture)), flow_.next(picture)};
}

CeilingFollower::Step CeilingFollower::follow(const Sight& sight) {
  Step step{sight.scan, sight.motion.has_value(), std::nullopt};
  const bool first = !begun_;
  if (!begun_) {
    begun_ = begin(step.scan, sight.stamp);
    if (!begun_) return step;
  } else if (sight.motion) {
    filter_.predict(*sight.motion, sight.stamp, step.scan.patches);
  } else {
    filter_.predict_unknown(sight.stamp);
  }
  step.update = filter_.update(step.scan.patches);
  if (first) filter_.take_cell_as_given();
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
