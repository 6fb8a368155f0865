#include "vigia/localization/points_information.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/localization/ekf_state.hpp"
#include "vigia/localization/points_model.hpp"

namespace vigia::localization {
namespace {

/// The sensor of a head that aims at the landmark, its zoom at the wanted focal length.
Shot aimed_shot(const HeadGeometry& geometry, const ZoomCalibration& zoom,
                const Eigen::Vector3d& p_r, double reach_m, double fill) {
  Shot shot;
  shot.head = aim_at(geometry, p_r);
  const double range = (camera_in_base(geometry, shot.head).translation() - p_r).norm();
  const double reach_px = fill * 0.5 * zoom.at(zoom.min_zoom_mm()).height;
  shot.zoom_mm = zoom.zoom_for_focal(reach_px * range / reach_m);
  shot.model = zoom.at(shot.zoom_mm);
  return shot;
}

/// Each point with the deviation that its mean over the look has.
std::vector<SeenPoint> points_of_look(const std::vector<LandmarkPoint>& model,
                                      const PointsInformationParams& params) {
  const double variance = params.pixel_sigma * params.pixel_sigma / params.frames_per_look;
  std::vector<SeenPoint> points;
  points.reserve(model.size());
  for (const LandmarkPoint& point : model)
    points.push_back({point, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity() / variance});
  return points;
}

bool fits(const std::vector<LandmarkPoint>& model, const Intrinsics& intrinsics,
          const Eigen::Isometry3d& cMl) {
  return std::all_of(model.begin(), model.end(), [&](const LandmarkPoint& point) {
    const auto image = predict_point(point, intrinsics, cMl);
    const double size = intrinsics.px * point.radius_m / cMl.translation().z();
    return image && in_image(intrinsics, image->uv, size);
  });
}

}  // namespace

std::optional<Eigen::Matrix3d> PointsInformation::look_information(const Landmark& landmark,
                                                                   const Pose2& pose) const {
  const std::vector<LandmarkPoint> model = landmark_points(landmark);
  if (model.empty()) return std::nullopt;
  double reach = 0.0;
  for (const LandmarkPoint& point : model)
    reach = std::max(reach, point.centre_l.norm() + point.radius_m);
  const Eigen::Vector3d p_r = on_ground_.ground.place(pose).inverse() * landmark.centre_w();
  const Shot shot = aimed_shot(geometry_, zoom_, p_r, reach, params_.fill);
  const Eigen::Isometry3d wMc = on_ground_.wMc(shot.camera, shot.head, pose);
  if (!fits(model, pinhole(shot), wMc.inverse() * landmark.wMl)) return std::nullopt;
  const auto measured =
      measure_points(points_of_look(model, params_), landmark.wMl, shot, on_ground_, pose, {});
  if (!measured) return std::nullopt;

  SensorNoise averaged = params_.sensor;
  averaged.reading_angle /= std::sqrt(params_.frames_per_look);
  const Eigen::Matrix<double, 6, 3> J = measured->H.leftCols<3>();
  const Eigen::Matrix<double, 6, 3> J_bias = measured->H.rightCols<3>();
  const Matrix6 S = reading_covariance(*measured, averaged) +
                    J_bias * look_covariance(params_.sensor) * J_bias.transpose();
  return J.transpose() * S.llt().solve(J);
}

}  // namespace vigia::localization
