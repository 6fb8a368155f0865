#include "vigia/localization/landmark_information.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
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

LandmarkInformation::LandmarkInformation(const HeadGeometry& geometry, ZoomCalibration zoom,
                                         const LandmarkInformationParams& params)
    : zoom_(std::move(zoom)), params_(params), model_(LandmarkMap{}, geometry, averaged(params)) {}

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

/// The sensor of a head that aims at the landmark, the zoom at @p focal_per_metre (px) times the
/// range.
SensorSnapshot LandmarkInformation::aimed_sensor(const Landmark& landmark, const Pose2& pose,
                                                 double focal_per_metre) const {
  const Eigen::Vector3d p_r = to_isometry(pose).inverse() * landmark.centre_w();
  SensorSnapshot sensor;
  sensor.head = aim_at(model_.geometry(), p_r);
  const double range = (camera_in_base(model_.geometry(), sensor.head).translation() - p_r).norm();
  sensor.zoom_mm = zoom_.zoom_for_focal(focal_per_metre * range);
  sensor.intrinsics = zoom_.at(sensor.zoom_mm);
  return sensor;
}

std::optional<Match> LandmarkInformation::expected_disc(const Landmark& landmark,
                                                        const DiscShape& disc,
                                                        const Pose2& pose) const {
  const SensorSnapshot sensor = aimed_sensor(landmark, pose, params_.radius_px / disc.radius_m);
  const auto image = predict_disc(landmark, sensor, model_.geometry(), pose, {});
  if (!image) return std::nullopt;
  const double size_px = std::exp(image->z(2));
  if (!in_image(sensor.intrinsics, image->z.head<2>(), size_px)) return std::nullopt;
  const double sigma_px = params_.disc_sigma_px;
  const Eigen::Vector3d sigma(sigma_px, sigma_px, sigma_px / (std::sqrt(2.0) * size_px));
  return DiscMatch{sensor, landmark, image->z, sigma.cwiseAbs2().asDiagonal()};
}

std::optional<Match> LandmarkInformation::expected_points(const Landmark& landmark,
                                                          const Pose2& pose) const {
  const std::vector<LandmarkPoint> points = landmark_points(landmark);
  double reach_m = 0.0;
  for (const LandmarkPoint& point : points)
    reach_m = std::max(reach_m, point.centre_l.norm() + point.radius_m);
  const double reach_px = params_.fill * 0.5 * zoom_.at(zoom_.min_zoom_mm()).height;
  const SensorSnapshot sensor = aimed_sensor(landmark, pose, reach_px / reach_m);
  const Eigen::Isometry3d wMc = to_isometry(pose) * camera_in_base(model_.geometry(), sensor.head);
  const Eigen::Isometry3d cMl = wMc.inverse() * landmark.wMl;
  const double variance = params_.point_sigma_px * params_.point_sigma_px / params_.frames_per_look;
  PointsMatch match{sensor, landmark, {}};
  for (const LandmarkPoint& point : points) {
    const auto image = predict_point(point, sensor.intrinsics, cMl);
    const double size_px = sensor.intrinsics.px * point.radius_m / cMl.translation().z();
    if (!image || !in_image(sensor.intrinsics, image->uv, size_px)) return std::nullopt;
    match.points.push_back({point, image->uv, Eigen::Matrix2d::Identity() / variance});
  }
  return match;
}

}  // namespace vigia::localization
