#include "stereo_eye.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vigia::perception {
namespace {

constexpr double kNearest_m = 0.06;  // before the cameras
constexpr double kFarther = 1.4;     // than the field is long: ranges have errors
constexpr int kAboveHorizon_px = 4;
constexpr double kSlackRows = 4.0;
/// σ of what a camera's response to light (gamma, overexposure) does to an edge: it moves towards
/// the darker side, by the same in both images.
constexpr double kResponse_px = 0.1;
constexpr double kTaller = 1.25;  // than a goal is an edge that is none of its

const FieldGoal* first_goal(const std::optional<FieldMap>& field) {
  return field && !field->goals.empty() ? &field->goals.front() : nullptr;
}

tracking::GoalCornerParams finder_params(const std::optional<StereoCameras>& cameras,
                                         const std::optional<FieldMap>& field) {
  tracking::GoalCornerParams params;
  const FieldGoal* goal = first_goal(field);
  // What is lower than level cameras lies below their horizon.
  if (cameras && goal != nullptr && cameras->height_m >= goal->height_m)
    params.first_row = std::max(0, static_cast<int>(cameras->intrinsics.v0) - kAboveHorizon_px);
  return params;
}

}  // namespace

StereoEye::StereoEye(const EyeParts& parts)
    : cameras_(stereo_cameras(parts.on_ground.rig)),
      field_(parts.field != nullptr ? std::optional<FieldMap>(*parts.field) : std::nullopt),
      left_(dynamic_cast<const StereoEye*>(parts.partner)),
      finder_(finder_params(cameras_, field_)) {
  if (!cameras_ || !field_) return;
  const double f_b = cameras_->intrinsics.px * cameras_->baseline_m;
  disparities_ = {f_b / (kFarther * std::hypot(field_->length_m, field_->width_m)),
                  f_b / kNearest_m};
}

/// Whether the edge is no taller than a goal at the depth that its disparity tells.
bool StereoEye::plausible(const tracking::GoalCornerImage& corner, double disparity_px) const {
  const FieldGoal* goal = first_goal(field_);
  if (goal == nullptr) return false;
  const double tall_px = disparity_px * goal->height_m / cameras_->baseline_m;
  return corner.rows <= kTaller * tall_px + kSlackRows;
}

std::vector<Observation> StereoEye::observe(const Capture& capture, const Belief& /*then*/,
                                            const std::optional<GazeRequest>& /*request*/) {
  return survey(capture);
}

std::vector<Observation> StereoEye::survey(const Capture& capture) {
  shot_ = capture.shot;
  scan_ = {};
  unmatched_ = 0;
  if (!cameras_ || !field_) return {};
  if (left_ == nullptr) {
    scan_ = finder_.find(capture.frame);
    return {};
  }
  if (!left_->shot_ || left_->shot_->stamp != capture.shot.stamp) return {};
  StereoObservation seen{*left_->shot_, capture.shot, {}};
  for (const tracking::GoalCornerImage& corner : left_->scan_.corners) {
    const auto same = finder_.find_same(capture.frame, corner, disparities_);
    if (!same || !plausible(corner, corner.u - same->u)) {
      ++unmatched_;
      continue;
    }
    scan_.corners.push_back(*same);
    StereoCorner both;
    both.corner = {corner.colour, corner.colour_on_right};
    both.left_uv = {corner.u, corner.v};
    both.right_uv = {same->u, same->v};
    both.covariance = Eigen::Vector2d(corner.sigma_px, same->sigma_px).cwiseAbs2().asDiagonal();
    both.covariance.array() += kResponse_px * kResponse_px;
    seen.corners.push_back(both);
  }
  return {seen};
}

std::vector<std::string> StereoEye::columns() const {
  return {"corners", "rejected", "unmatched"};
}

void StereoEye::append_cells(std::string& line) const {
  line += fmt::format(",{},{},{}", scan_.corners.size(), scan_.rejected, unmatched_);
}

imaging::Overlay StereoEye::overlay() const {
  imaging::Overlay overlay;
  for (const tracking::GoalCornerImage& corner : scan_.corners)
    overlay.points.emplace_back(corner.u, corner.v);
  overlay.lines = {fmt::format("{} corners", scan_.corners.size())};
  return overlay;
}

}  // namespace vigia::perception
