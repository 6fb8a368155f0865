#include "vigia/localization/stereo_pair.hpp"

#include <cmath>

namespace vigia::localization {
namespace {

/// Column of one camera of the pair: @p side is +1 left, −1 right.
struct Column {
  double u = 0.0;
  Eigen::RowVector2d du_dp = Eigen::RowVector2d::Zero();
  Eigen::RowVector3d du_derrors = Eigen::RowVector3d::Zero();
};

std::optional<Column> column_of(const StereoPair& pair, const StereoErrors& errors, double side,
                                const Eigen::Vector2d& p_r) {
  const double focal = pair.focal_px * (1.0 + errors.focal);
  const Eigen::Vector2d centre(pair.forward_m,
                               0.5 * side * pair.baseline_m * (1.0 + errors.baseline));
  const double yaw = -0.5 * side * errors.vergence;
  Eigen::Matrix2d cRr;  // the camera's axis is its x here
  cRr << std::cos(yaw), std::sin(yaw), -std::sin(yaw), std::cos(yaw);
  const Eigen::Vector2d q = cRr * (p_r - centre);
  if (!(q.x() > 1e-6)) return std::nullopt;
  const Eigen::RowVector2d du_dq(focal * q.y() / (q.x() * q.x()), -focal / q.x());
  const Eigen::Vector2d dq_dyaw(q.y(), -q.x());
  const Eigen::Vector2d dq_dbaseline = -cRr * Eigen::Vector2d(0.0, 0.5 * side * pair.baseline_m);
  Column column;
  column.u = pair.u0 - focal * q.y() / q.x();
  column.du_dp = du_dq * cRr;
  column.du_derrors << du_dq * dq_dbaseline, -0.5 * side * du_dq.dot(dq_dyaw),
      -pair.focal_px * q.y() / q.x();
  return column;
}

}  // namespace

StereoPair stereo_pair(const StereoCameras& cameras) {
  return {cameras.intrinsics.px, cameras.intrinsics.u0, cameras.baseline_m, cameras.forward_m};
}

std::optional<StereoImage> stereo_image(const StereoPair& pair, const StereoErrors& errors,
                                        const Eigen::Vector2d& p_r) {
  const auto left = column_of(pair, errors, 1.0, p_r);
  const auto right = column_of(pair, errors, -1.0, p_r);
  if (!left || !right) return std::nullopt;
  StereoImage image;
  image.columns << left->u, right->u;
  image.dcolumns_dp << left->du_dp, right->du_dp;
  image.dcolumns_derrors << left->du_derrors, right->du_derrors;
  return image;
}

std::optional<StereoPoint> triangulate(const StereoPair& pair, const StereoColumns& columns,
                                       double sigma_px) {
  const double disparity = columns.left - columns.right;
  if (!(disparity > 0.0)) return std::nullopt;
  const double x = pair.focal_px * pair.baseline_m / disparity;
  const double off_axis = 0.5 * (columns.left + columns.right) - pair.u0;
  const double slope = -off_axis / pair.focal_px;
  const double dx = x / disparity;
  Eigen::Matrix2d dp_dcolumns;
  dp_dcolumns << -dx, dx,  //
      -0.5 * x / pair.focal_px - slope * dx, -0.5 * x / pair.focal_px + slope * dx;
  return StereoPoint{{x + pair.forward_m, slope * x},
                     sigma_px * sigma_px * dp_dcolumns * dp_dcolumns.transpose()};
}

PolarSighting polar(const StereoPoint& point) {
  const double range = point.p_r.norm();
  const Eigen::Vector2d u = point.p_r / range;
  Eigen::Matrix2d J;
  J << u.x(), u.y(), -u.y() / range, u.x() / range;
  return {range, std::atan2(u.y(), u.x()), J * point.covariance * J.transpose()};
}

}  // namespace vigia::localization
