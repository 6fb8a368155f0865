#pragma once

#include "ellipse_shape.hpp"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace vigia::tracking {

/// A homography from a landmark's plane (m, y up) to the image.
struct PlaneMap {
  Eigen::Matrix3d iHl = Eigen::Matrix3d::Identity();

  Eigen::Vector2d operator()(const Eigen::Vector2d& p_l) const;
  /// The point of the plane that is seen at @p uv.
  Eigen::Vector2d inverse(const Eigen::Vector2d& uv) const;
  /// ∂(u, v)/∂(x, y) at a point of the plane.
  Eigen::Matrix2d jacobian(const Eigen::Vector2d& p_l) const;
  /// The image of a small circle, to first order.
  EllipseShape circle(const Eigen::Vector2d& centre_l, double radius) const;
};

struct PlanePoint {
  Eigen::Vector2d p_l = Eigen::Vector2d::Zero();
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
};

/// The homography of least algebraic error through at least four points in general position.
/// Nothing when they are degenerate.
std::optional<PlaneMap> fit_plane_map(const std::vector<PlanePoint>& points);

}  // namespace vigia::tracking
