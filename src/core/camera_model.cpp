#include "vigia/core/camera_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace vigia {
namespace {

using Matrix23 = Eigen::Matrix<double, 2, 3>;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

/// ∂(v/|v|)/∂v.
Eigen::Matrix3d normalise_jacobian(const Eigen::Vector3d& v) {
  const double norm = v.norm();
  const Eigen::Vector3d unit = v / norm;
  return (Eigen::Matrix3d::Identity() - unit * unit.transpose()) / norm;
}

std::optional<Eigen::Vector3d> ray_of(const Intrinsics& pinhole, const Eigen::Vector2d& uv) {
  return unproject(pinhole, uv).homogeneous().normalized();
}

std::optional<Eigen::Vector3d> ray_of(const UnifiedOmni& omni, const Eigen::Vector2d& uv) {
  // Mei & Rives eq. 4: X_s = (η x, η y, η − ξ).
  const Eigen::Vector2d m((uv.x() - omni.u0) / omni.px, (uv.y() - omni.v0) / omni.py);
  const double r2 = m.squaredNorm();
  const double root = 1.0 + (1.0 - omni.xi * omni.xi) * r2;
  if (root < 0.0) return std::nullopt;
  const double eta = (omni.xi + std::sqrt(root)) / (1.0 + r2);
  if (eta - omni.xi < min_z(omni)) return std::nullopt;
  return Eigen::Vector3d(eta * m.x(), eta * m.y(), eta - omni.xi);
}

std::optional<Eigen::Vector2d> pixel_of(const Intrinsics& pinhole, const Eigen::Vector3d& p_c) {
  return project(pinhole, p_c);
}

std::optional<Eigen::Vector2d> pixel_of(const UnifiedOmni& omni, const Eigen::Vector3d& p_c) {
  const double norm = p_c.norm();
  if (norm <= 1e-9 || p_c.z() < min_z(omni) * norm) return std::nullopt;
  const Eigen::Vector2d m = p_c.head<2>() / (p_c.z() + omni.xi * norm);
  return Eigen::Vector2d(omni.u0 + omni.px * m.x(), omni.v0 + omni.py * m.y());
}

Matrix23 pixel_jacobian(const Intrinsics& pinhole, const Eigen::Vector3d& p_c,
                        const Eigen::Vector2d& uv) {
  Matrix23 dxy_dp;
  dxy_dp << 1.0, 0.0, -p_c.x() / p_c.z(), 0.0, 1.0, -p_c.y() / p_c.z();
  return distort_jacobian(pinhole, uv) * dxy_dp / p_c.z();
}

Matrix23 pixel_jacobian(const UnifiedOmni& omni, const Eigen::Vector3d& p_c,
                        const Eigen::Vector2d& /*uv*/) {
  // m = (x, y)/q with q = z + ξ |p|.
  const double norm = p_c.norm();
  const double q = p_c.z() + omni.xi * norm;
  const Eigen::RowVector3d dq_dp = Eigen::RowVector3d::UnitZ() + omni.xi * p_c.transpose() / norm;
  Matrix23 dm_dp = Matrix23::Identity();
  dm_dp -= p_c.head<2>() * dq_dp / q;
  return Eigen::Vector2d(omni.px, omni.py).asDiagonal() * dm_dp / q;
}

Matrix32 direction_jacobian(const Intrinsics& pinhole, const Eigen::Vector2d& uv) {
  const Eigen::Vector3d direction = unproject(pinhole, uv).homogeneous();
  return normalise_jacobian(direction).leftCols<2>() * distort_jacobian(pinhole, uv).inverse();
}

Matrix32 direction_jacobian(const UnifiedOmni& omni, const Eigen::Vector2d& uv) {
  const Eigen::Vector2d m((uv.x() - omni.u0) / omni.px, (uv.y() - omni.v0) / omni.py);
  const double r2 = m.squaredNorm();
  const double root = std::sqrt(1.0 + (1.0 - omni.xi * omni.xi) * r2);
  const double eta = (omni.xi + root) / (1.0 + r2);
  const double deta_dr2 = (0.5 * (1.0 - omni.xi * omni.xi) / root - eta) / (1.0 + r2);
  const Eigen::RowVector2d deta_dm = 2.0 * deta_dr2 * m.transpose();
  Matrix32 direction;
  direction.topRows<2>() = eta * Eigen::Matrix2d::Identity() + m * deta_dm;
  direction.bottomRows<1>() = deta_dm;
  return direction * Eigen::Vector2d(1.0 / omni.px, 1.0 / omni.py).asDiagonal();
}

}  // namespace

double min_z(const UnifiedOmni& omni) {
  // Z_s + ξ vanishes, or the image folds over at Z_s = −1/ξ, where the rays from the second centre
  // touch the sphere.
  constexpr double kMargin = 1e-9;
  const double fold = omni.xi > 1.0 ? -1.0 / omni.xi : -omni.xi;
  return std::max(std::cos(omni.max_angle), fold + kMargin);
}

int image_width(const CameraModel& model) {
  return std::visit([](const auto& m) { return m.width; }, model);
}

int image_height(const CameraModel& model) {
  return std::visit([](const auto& m) { return m.height; }, model);
}

std::optional<Eigen::Vector3d> ray(const CameraModel& model, const Eigen::Vector2d& uv) {
  return std::visit([&](const auto& m) { return ray_of(m, uv); }, model);
}

std::optional<Eigen::Vector2d> project(const CameraModel& model, const Eigen::Vector3d& p_c) {
  return std::visit([&](const auto& m) { return pixel_of(m, p_c); }, model);
}

std::optional<Eigen::Matrix<double, 2, 3>> project_jacobian(const CameraModel& model,
                                                            const Eigen::Vector3d& p_c) {
  return std::visit(
      [&](const auto& m) -> std::optional<Matrix23> {
        const auto uv = pixel_of(m, p_c);
        if (!uv) return std::nullopt;
        return pixel_jacobian(m, p_c, *uv);
      },
      model);
}

std::optional<Eigen::Matrix<double, 3, 2>> ray_jacobian(const CameraModel& model,
                                                        const Eigen::Vector2d& uv) {
  return std::visit(
      [&](const auto& m) -> std::optional<Matrix32> {
        if (!ray_of(m, uv)) return std::nullopt;
        return direction_jacobian(m, uv);
      },
      model);
}

bool in_image(const CameraModel& model, const Eigen::Vector2d& uv, double margin) {
  return uv.x() >= margin && uv.y() >= margin && uv.x() <= image_width(model) - 1 - margin &&
         uv.y() <= image_height(model) - 1 - margin;
}

}  // namespace vigia
