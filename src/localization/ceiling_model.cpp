#include "vigia/localization/ceiling_model.hpp"

#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

constexpr double kTiltedFlow = 0.3;  // how far from the middle the texture's may be, in distances

Eigen::Matrix3d tilt_rotation(const CeilingCameraErrors& errors) {
  const Eigen::Vector3d tilt(errors.tilt_x, errors.tilt_y, 0.0);
  const double angle = tilt.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, tilt / angle).toRotationMatrix();
}

/// How the levelled direction (x, y) at unit distance moves with the tilt: δ × r over r's height.
Eigen::Matrix2d tilt_jacobian(const Eigen::Vector2d& m) {
  Eigen::Matrix2d jacobian;
  jacobian << -m.x() * m.y(), 1.0 + m.x() * m.x(), -1.0 - m.y() * m.y(), m.x() * m.y();
  return jacobian;
}

/// ∂ of the direction's angle by the tilt: the field of tilt_jacobian() differentiated along d.
Eigen::RowVector2d direction_jacobian(const Eigen::Vector2d& m, const Eigen::Vector2d& d) {
  Eigen::Matrix2d along;  // columns: d of the field by tilt_x, by tilt_y
  along << -m.y() * d.x() - m.x() * d.y(), 2.0 * m.x() * d.x(), -2.0 * m.y() * d.y(),
      m.y() * d.x() + m.x() * d.y();
  return {cross(d, along.col(0)), cross(d, along.col(1))};
}

}  // namespace

CeilingCamera corrected(const CeilingCamera& camera, const CeilingCameraErrors& errors) {
  CeilingCamera right = camera;
  right.rMc.linear() = tilt_rotation(errors) * camera.rMc.linear();
  right.ceiling_m = camera.rMc.translation().z() + camera.rise_m() * std::exp(errors.log_height);
  return right;
}

std::optional<PatchOnCeiling> on_ceiling(const CeilingCamera& camera, const PatchImage& patch,
                                         const CeilingCameraErrors& errors) {
  const auto direction = ray(camera.model, patch.uv);
  const auto dray_duv = ray_jacobian(camera.model, patch.uv);
  if (!direction || !dray_duv) return std::nullopt;
  const Eigen::Matrix3d rRc = tilt_rotation(errors) * camera.rMc.linear();
  const Eigen::Vector3d r = rRc * *direction;
  if (r.z() < 1e-3) return std::nullopt;
  const double rise = camera.rise_m() * std::exp(errors.log_height);
  const Eigen::Vector2d m = r.head<2>() / r.z();
  Eigen::Matrix<double, 2, 3> dm_dr;
  dm_dr << 1.0, 0.0, -m.x(), 0.0, 1.0, -m.y();
  const Eigen::Matrix2d dm_duv = dm_dr / r.z() * rRc * *dray_duv;
  const Eigen::Vector2d along(std::cos(patch.angle), std::sin(patch.angle));
  const Eigen::Vector2d dm = dm_duv * along;
  const Eigen::Vector2d d = dm.normalized();

  PatchOnCeiling seen;
  seen.q = camera.rMc.translation().head<2>() + rise * m;
  seen.psi = std::atan2(d.y(), d.x());
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  J.topLeftCorner<2, 2>() = rise * dm_duv;
  J(2, 2) = cross(d, dm_duv * Eigen::Vector2d(-along.y(), along.x())) / dm.norm();
  seen.covariance = J * patch.covariance * J.transpose();
  seen.derrors.topLeftCorner<2, 2>() = rise * tilt_jacobian(m);
  seen.derrors.topRightCorner<2, 1>() = rise * m;
  seen.derrors.bottomLeftCorner<1, 2>() = direction_jacobian(m, d);
  return seen;
}

PatchOnCeiling with_errors(const CeilingCamera& camera, const PatchOnCeiling& patch,
                           const CeilingCameraErrors& from, const CeilingCameraErrors& to) {
  const Eigen::Vector2d c = camera.rMc.translation().head<2>();
  const Eigen::Vector2d then = (patch.q - c) / (camera.rise_m() * std::exp(from.log_height));
  const Eigen::Matrix3d turn = tilt_rotation(to) * tilt_rotation(from).transpose();
  const Eigen::Vector3d r = turn * Eigen::Vector3d(then.x(), then.y(), 1.0);
  const double rise = camera.rise_m() * std::exp(to.log_height);
  const Eigen::Vector2d m = r.head<2>() / r.z();
  Eigen::Matrix<double, 2, 3> dm_dr;
  dm_dr << 1.0, 0.0, -m.x(), 0.0, 1.0, -m.y();
  const Eigen::Vector3d along =
      turn * Eigen::Vector3d(std::cos(patch.psi), std::sin(patch.psi), 0.0);
  const Eigen::Vector2d d = (dm_dr * along / r.z()).normalized();
  PatchOnCeiling now;
  now.q = c + rise * m;
  now.psi = std::atan2(d.y(), d.x());
  now.derrors.topLeftCorner<2, 2>() = rise * tilt_jacobian(m);
  now.derrors.topRightCorner<2, 1>() = rise * m;
  now.derrors.bottomLeftCorner<1, 2>() = direction_jacobian(m, d);
  return now;
}

Pose2 robot_motion(const CeilingCamera& camera, const ImageShift& shift) {
  // The camera's own motion, then the robot's about it.
  const Eigen::Vector2d c = camera.rMc.translation().head<2>();
  const Eigen::Vector2d moved =
      c + camera.rise_m() * shift.shift - Eigen::Rotation2Dd(shift.turn) * c;
  return {moved.x(), moved.y(), wrap_angle(shift.turn)};
}

ImageShift seen_shift(const CeilingCamera& camera, const Pose2& motion) {
  const Eigen::Vector2d c = camera.rMc.translation().head<2>();
  ImageShift shift;
  shift.shift = (motion.position() - c + Eigen::Rotation2Dd(motion.theta) * c) / camera.rise_m();
  shift.turn = motion.theta;
  return shift;
}

FlowMotion flow_motion(const CeilingCamera& camera, const ImageShift& shift,
                       const CeilingCameraErrors& errors, double tilt_variance, double floor) {
  const CeilingCamera right = corrected(camera, errors);
  const double rise = right.rise_m();
  const Eigen::Vector2d tilt(errors.tilt_x, errors.tilt_y);
  Eigen::Matrix2d beside;
  beside << 0.0, -1.0, 1.0, 0.0;
  const Eigen::Matrix2d dshift_dtilt =
      (Eigen::Rotation2Dd(shift.turn).toRotationMatrix() - Eigen::Matrix2d::Identity()) * beside;
  ImageShift level = shift;
  level.shift += dshift_dtilt * tilt;
  FlowMotion motion;
  motion.step = robot_motion(right, level);
  motion.derrors.topLeftCorner<2, 2>() = rise * dshift_dtilt;
  motion.derrors.topRightCorner<2, 1>() = rise * level.shift;
  motion.covariance = shift.covariance;
  motion.covariance.diagonal().array() += floor * floor + kTiltedFlow * kTiltedFlow *
                                                              (tilt.squaredNorm() + tilt_variance) *
                                                              shift.shift.squaredNorm();
  motion.covariance.topRows<2>() *= rise;
  motion.covariance.leftCols<2>() *= rise;
  return motion;
}

}  // namespace vigia::localization
