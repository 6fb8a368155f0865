#include "vigia/evaluation/view_bound.hpp"

#include <cmath>

#include <Eigen/LU>

namespace vigia::evaluation {

SphericalView spherical_view(const Eigen::Vector3d& p_l) {
  // World axes of the paper: X_w = −x, Y_w = z, Z_w = y; the camera at
  // D (−sin φ sin θ, cos φ, −sin φ cos θ).
  const double D = p_l.norm();
  const double flat2 = p_l.head<2>().squaredNorm();
  SphericalView view;
  view.phi_theta_distance << std::atan2(std::sqrt(flat2), p_l.z()), std::atan2(p_l.x(), -p_l.y()),
      D;
  const Eigen::RowVector3d e(0.0, 0.0, 1.0);
  view.by_position_l.row(0) = (p_l.z() / (D * D) * p_l.transpose() - e) / std::sqrt(flat2);
  view.by_position_l.row(1) << -p_l.y() / flat2, p_l.x() / flat2, 0.0;
  view.by_position_l.row(2) = p_l.transpose() / D;
  return view;
}

std::optional<ViewBound> view_bound(const std::vector<localization::SeenPoint>& points,
                                    const Intrinsics& intrinsics, const Eigen::Isometry3d& cMl) {
  const auto fit = localization::fit_points(points, intrinsics, cMl);
  if (!fit) return std::nullopt;
  const Eigen::FullPivLU<localization::PoseMatrix> information(
      fit->information.topLeftCorner<6, 6>());
  if (!information.isInvertible()) return std::nullopt;
  // p_l = −Rᵀ t, and δ = (v, ω) moves it by −Rᵀ (v + t × ω).
  const Eigen::Matrix3d lRc = cMl.linear().transpose();
  const Eigen::Vector3d t = cMl.translation();
  Eigen::Matrix3d cross;
  cross << 0.0, -t.z(), t.y(), t.z(), 0.0, -t.x(), -t.y(), t.x(), 0.0;
  Eigen::Matrix<double, 3, 6> J;
  J << -lRc, -lRc * cross;
  ViewBound bound;
  bound.position_l = J * information.inverse() * J.transpose();
  const Eigen::Matrix3d by_position = spherical_view(-(lRc * t)).by_position_l;
  bound.phi_theta_distance = by_position * bound.position_l * by_position.transpose();
  return bound;
}

}  // namespace vigia::evaluation
