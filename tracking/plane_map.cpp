#include "plane_map.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace vigia::tracking {

Eigen::Vector2d PlaneMap::operator()(const Eigen::Vector2d& p_l) const {
  const Eigen::Vector3d h = iHl * Eigen::Vector3d(p_l.x(), p_l.y(), 1.0);
  return h.head<2>() / h.z();
}

Eigen::Vector2d PlaneMap::inverse(const Eigen::Vector2d& uv) const {
  const Eigen::Vector3d p = iHl.inverse() * Eigen::Vector3d(uv.x(), uv.y(), 1.0);
  return p.head<2>() / p.z();
}

Eigen::Matrix2d PlaneMap::jacobian(const Eigen::Vector2d& p_l) const {
  const Eigen::Vector3d h = iHl * Eigen::Vector3d(p_l.x(), p_l.y(), 1.0);
  const Eigen::Vector2d uv = h.head<2>() / h.z();
  return (iHl.topLeftCorner<2, 2>() - uv * iHl.block<1, 2>(2, 0)) / h.z();
}

EllipseShape PlaneMap::circle(const Eigen::Vector2d& centre_l, double radius) const {
  const Eigen::Matrix2d J = radius * jacobian(centre_l);
  return {(*this)(centre_l), J * J.transpose()};
}

std::optional<PlaneMap> fit_plane_map(const std::vector<PlanePoint>& points) {
  if (points.size() < 4) return std::nullopt;
  Eigen::Vector2d mean_l = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_uv = Eigen::Vector2d::Zero();
  for (const PlanePoint& point : points) {
    mean_l += point.p_l / static_cast<double>(points.size());
    mean_uv += point.uv / static_cast<double>(points.size());
  }
  double spread_l = 0.0;
  double spread_uv = 0.0;
  for (const PlanePoint& point : points) {
    spread_l = std::max(spread_l, (point.p_l - mean_l).norm());
    spread_uv = std::max(spread_uv, (point.uv - mean_uv).norm());
  }
  if (spread_l <= 0.0 || spread_uv <= 0.0) return std::nullopt;

  // In coordinates round the means, where the last entry of the matrix is far from 0.
  using Normal = Eigen::Matrix<double, 8, 8>;
  using Vector = Eigen::Matrix<double, 8, 1>;
  Normal normal = Normal::Zero();
  Vector right = Vector::Zero();
  for (const PlanePoint& point : points) {
    const Eigen::Vector2d p = (point.p_l - mean_l) / spread_l;
    const Eigen::Vector2d q = (point.uv - mean_uv) / spread_uv;
    Vector row_u;
    Vector row_v;
    row_u << p.x(), p.y(), 1.0, 0.0, 0.0, 0.0, -q.x() * p.x(), -q.x() * p.y();
    row_v << 0.0, 0.0, 0.0, p.x(), p.y(), 1.0, -q.y() * p.x(), -q.y() * p.y();
    normal.noalias() += row_u * row_u.transpose() + row_v * row_v.transpose();
    right += row_u * q.x() + row_v * q.y();
  }
  const Eigen::LDLT<Normal> factors(normal);
  constexpr double kSingular = 1e-9;
  if (factors.info() != Eigen::Success || factors.rcond() < kSingular) return std::nullopt;
  const Vector h = factors.solve(right);
  Eigen::Matrix3d H;
  H << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1.0;
  Eigen::Matrix3d to_unit;
  to_unit << 1.0 / spread_l, 0.0, -mean_l.x() / spread_l, 0.0, 1.0 / spread_l,
      -mean_l.y() / spread_l, 0.0, 0.0, 1.0;
  Eigen::Matrix3d to_image;
  to_image << spread_uv, 0.0, mean_uv.x(), 0.0, spread_uv, mean_uv.y(), 0.0, 0.0, 1.0;
  PlaneMap map{to_image * H * to_unit};
  if (!map.iHl.allFinite()) return std::nullopt;
  return map;
}

}  // namespace vigia::tracking
