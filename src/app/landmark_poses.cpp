#include "landmark_poses.hpp"

#include <utility>

#include <fmt/format.h>

#include "vigia/core/error.hpp"
#include "vigia/localization/points_pose.hpp"

namespace vigia::app {
namespace {

PatternShape pattern_of_sheet(const PatternCode& code, double side_m) {
  PatternShape shape;
  shape.code = code;
  return scaled(shape, 0.5 * side_m / shape.sheet_half_width_m);
}

bool says(const Landmark& landmark, const tracking::LandmarkCode& code) {
  if (const auto* tag = std::get_if<TagShape>(&landmark.shape))
    return code == tracking::LandmarkCode(tag->tag);
  if (const auto* pattern = std::get_if<PatternShape>(&landmark.shape))
    return code == tracking::LandmarkCode(pattern->code);
  return false;
}

const char* to_text(localization::PointsPoseStatus status) {
  switch (status) {
    case localization::PointsPoseStatus::solved:
      return "solved";
    case localization::PointsPoseStatus::ambiguous:
      return "ambiguous";
    case localization::PointsPoseStatus::too_few:
      return "too_few_points";
    case localization::PointsPoseStatus::degenerate:
      return "degenerate";
    case localization::PointsPoseStatus::not_converged:
      return "not_converged";
  }
  return "unknown";
}

}  // namespace

LandmarkPoses::LandmarkPoses(const Intrinsics& camera, LandmarkSizes sizes)
    : camera_(camera), sizes_(std::move(sizes)), disc_radius_m_(0.5 * sizes_.size_m) {
  if (sizes_.size_m > 0.0) return;
  for (const Landmark& landmark : sizes_.map.all()) {
    const auto radius = disc_radius(landmark);
    if (!radius) continue;
    if (disc_radius_m_ > 0.0 && disc_radius_m_ != *radius)
      throw InputError(
          "--landmarks: the discs have several radii, and discs look all alike: give "
          "--size");
    disc_radius_m_ = *radius;
  }
}

std::optional<Landmark> LandmarkPoses::landmark_of(const tracking::LandmarkCode& code) const {
  if (sizes_.size_m > 0.0) {
    Landmark landmark;
    if (const int* tag = std::get_if<int>(&code))
      landmark.shape = TagShape{*tag, sizes_.size_m};
    else
      landmark.shape = pattern_of_sheet(std::get<PatternCode>(code), sizes_.size_m);
    return landmark;
  }
  for (const Landmark& landmark : sizes_.map.all())
    if (says(landmark, code)) return landmark;
  return std::nullopt;
}

std::vector<LandmarkPose> LandmarkPoses::of(const tracking::EllipseFeature& feature) const {
  std::vector<LandmarkPose> poses;
  if (feature.status != tracking::FeatureStatus::found || disc_radius_m_ <= 0.0) return poses;
  const auto solved =
      localization::disc_poses(feature.ellipse, feature.covariance, disc_radius_m_, camera_);
  const char* status = solved.size() > 1 ? "ambiguous" : "solved";
  for (const localization::DiscPose& pose : solved)
    poses.push_back({static_cast<int>(poses.size()) + 1, status, pose.cMl, pose.covariance});
  return poses;
}

std::vector<LandmarkPose> LandmarkPoses::of(const tracking::PointsFeature& feature) const {
  if (feature.status != tracking::FeatureStatus::found) return {};
  const auto landmark = landmark_of(*feature.code);
  if (!landmark) return {};
  PointsObservation observation;
  observation.points = feature.points;
  const localization::PointsPose solved =
      localization::solve_points(localization::seen_points(*landmark, observation), camera_);
  if (!solved.has_pose()) return {};
  const std::string status = to_text(solved.status);
  std::vector<LandmarkPose> poses{{1, status, solved.pose.cMl, solved.pose.covariance}};
  if (solved.status == localization::PointsPoseStatus::ambiguous && solved.twin)
    poses.push_back({2, status, solved.twin->cMl, solved.twin->covariance});
  return poses;
}

std::string pose_csv_header() {
  std::string header = "solution,pose_status,x_m,y_m,z_m,turn_x_rad,turn_y_rad,turn_z_rad";
  const char* names[] = {"x", "y", "z", "wx", "wy", "wz"};
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) header += fmt::format(",c_{}_{}", names[i], names[j]);
  return header;
}

std::string pose_csv_fields(const LandmarkPose& pose) {
  const Eigen::AngleAxisd turn(pose.cMl.linear());
  const Eigen::Vector3d t = pose.cMl.translation();
  const Eigen::Vector3d w = turn.angle() * turn.axis();
  std::string fields = fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}", pose.solution,
                                   pose.status, t.x(), t.y(), t.z(), w.x(), w.y(), w.z());
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) fields += fmt::format(",{:.6e}", pose.covariance(i, j));
  return fields;
}

}  // namespace vigia::app
