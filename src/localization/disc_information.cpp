#include "vigia/localization/disc_information.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/localization/ekf_state.hpp"

namespace vigia::localization {
namespace {

/// The sensor of a head that aims at the landmark with the zoom that shows it as wanted.
Shot aimed_shot(const HeadGeometry& geometry, const ZoomCalibration& zoom,
                const Eigen::Vector3d& p_r, double focal_per_metre) {
  Shot shot;
  shot.head = aim_at(geometry, p_r);
  const double range = (camera_in_base(geometry, shot.head).translation() - p_r).norm();
  shot.zoom_mm = zoom.zoom_for_focal(focal_per_metre * range);
  shot.model = zoom.at(shot.zoom_mm);
  return shot;
}

bool fits(const Intrinsics& intrinsics, const DiscMeasurement& image) {
  return in_image(intrinsics, image.z.head<2>(), std::exp(image.z(2)));
}

}  // namespace

std::optional<Eigen::Matrix3d> DiscInformation::look_information(const Landmark& landmark,
                                                                 const Pose2& pose) const {
  const auto radius = disc_radius(landmark);
  if (!radius) return std::nullopt;
  const Eigen::Vector3d p_r = on_ground_.ground.place(pose).inverse() * landmark.centre_w();
  const Shot shot = aimed_shot(geometry_, zoom_, p_r, params_.radius_px / *radius);
  const auto image = predict_disc(landmark, shot, on_ground_, pose, {});
  if (!image || !fits(pinhole(shot), *image)) return std::nullopt;

  const double size_sigma = params_.pixel_sigma / (std::sqrt(2.0) * std::exp(image->z(2)));
  const Eigen::Vector3d sigma(params_.pixel_sigma, params_.pixel_sigma, size_sigma);
  Eigen::Matrix3d S = sigma.cwiseAbs2().asDiagonal();
  S += image->dz_dbias * look_covariance(params_.sensor) * image->dz_dbias.transpose();
  S += reading_covariance(*image, params_.sensor) / params_.frames_per_look;
  return image->dz_dpose.transpose() * S.llt().solve(image->dz_dpose);
}

}  // namespace vigia::localization
