#include "vigia/localization/landmark_information.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "vigia/core/overloaded.hpp"

namespace vigia::localization {
namespace {

/// White errors averaged over the look.
MeasurementParams averaged(const LandmarkInformationParams& params) {
  MeasurementParams measurement;
  measurement.sensor = params.sensor;
  measurement.sensor.reading_angle /= std::sqrt(params.frames_per_look);
  return measurement;
}

template <int Rows>
Eigen::Matrix3d information_of(const Linearised<Rows>& seen, const Eigen::Matrix3d& biases) {
  const Eigen::Matrix<double, Rows, 3> J = pose_jacobian(seen);
  return J.transpose() * marginal_covariance(seen, biases).llt().solve(J);
}

}  // namespace

LandmarkInformation::LandmarkInformation(const HeadGeometry& geometry, const ZoomCalibration& zoom,
                                         const LandmarkInformationParams& params,
                                         const Ground& ground)
    : geometry_(geometry),
      zoom_(zoom),
      params_(params),
      model_(LandmarkMap{}, {head_rig(geometry, zoom), ground}, averaged(params)) {}

std::optional<Eigen::Matrix3d> LandmarkInformation::look_information(const Landmark& landmark,
                                                                     const Pose2& pose) const {
  const auto match = std::visit(
      Overloaded{[&](const DiscShape& disc) { return expected_disc(landmark, disc, pose); },
                 [&](const PatternShape&) { return expected_points(landmark, pose); },
                 [&](const TagShape&) { return expected_points(landmark, pose); }},
      landmark.shape);
  if (!match) return std::nullopt;
  const Eigen::Matrix3d biases = look_covariance(params_.sensor);
  std::optional<Eigen::Matrix3d> information;
  model_.linearise(*match, state_vector(pose),
                   [&](const auto& seen) { information = information_of(seen, biases); });
  return information;
}

/// The shot of a head that aims at the landmark, the zoom at @p focal_per_metre (px) times the
/// range.
Shot LandmarkInformation::aimed_shot(const Landmark& landmark, const Pose2& pose,
                                     double focal_per_metre) const {
  const Eigen::Vector3d p_r = model_.on_ground().ground.place(pose).inverse() * landmark.centre_w();
  Shot shot;
  shot.head = aim_at(geometry_, p_r);
  const double range = (camera_in_base(geometry_, shot.head).translation() - p_r).norm();
  shot.zoom_mm = zoom_.zoom_for_focal(focal_per_metre * range);
  shot.model = zoom_.at(shot.zoom_mm);
  return shot;
}

std::optional<Match> LandmarkInformation::expected_disc(const Landmark& landmark,
                                                        const DiscShape& disc,
                                                        const Pose2& pose) const {
  const Shot shot = aimed_shot(landmark, pose, params_.radius_px / disc.radius_m);
  const auto image = predict_disc(landmark, shot, model_.on_ground(), pose, {});
  if (!image) return std::nullopt;
  const double size_px = std::exp(image->z(2));
  if (!in_image(pinhole(shot), image->z.head<2>(), size_px)) return std::nullopt;
  const double sigma_px = params_.disc_sigma_px;
  const Eigen::Vector3d sigma(sigma_px, sigma_px, sigma_px / (std::sqrt(2.0) * size_px));
  return DiscMatch{shot, landmark, image->z, sigma.cwiseAbs2().asDiagonal()};
}

std::optional<Match> LandmarkInformation::expected_points(const Landmark& landmark,
                                                          const Pose2& pose) const {
  const std::vector<LandmarkPoint> points = landmark_points(landmark);
  double reach_m = 0.0;
  for (const LandmarkPoint& point : points)
    reach_m = std::max(reach_m, point.centre_l.norm() + point.radius_m);
  const double reach_px = params_.fill * 0.5 * zoom_.at(zoom_.min_zoom_mm()).height;
  const Shot shot = aimed_shot(landmark, pose, reach_px / reach_m);
  const Eigen::Isometry3d wMc = model_.on_ground().wMc(shot.camera, shot.head, pose);
  const Eigen::Isometry3d cMl = wMc.inverse() * landmark.wMl;
  const double variance = params_.point_sigma_px * params_.point_sigma_px / params_.frames_per_look;
  PointsMatch match{shot, landmark, {}};
  for (const LandmarkPoint& point : points) {
    const auto image = predict_point(point, pinhole(shot), cMl);
    const double size_px = pinhole(shot).px * point.radius_m / cMl.translation().z();
    if (!image || !in_image(pinhole(shot), image->uv, size_px)) return std::nullopt;
    match.points.push_back({point, image->uv, Eigen::Matrix2d::Identity() / variance});
  }
  return match;
}

}  // namespace vigia::localization
