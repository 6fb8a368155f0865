#include "covered_ellipse.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace vigia::tracking {
namespace {

constexpr std::size_t kLeastPoints = 16;
constexpr double kLeastAxis = 5.0;    // px
constexpr double kOnOutline = 0.8;    // px from the ellipse
constexpr double kLeastShare = 0.55;  // of the outline's points that lie on the ellipse

using Conic = Eigen::Matrix<double, 5, 1>;

/// Sums over points for the conic a x² + b xy + c y² + d x + e y = 1 of least squares.
struct ConicSums {
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Conic product = Conic::Zero();

  void add(const Eigen::Vector2d& p) {
    Conic row;
    row << p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y();
    normal += row * row.transpose();
    product += row;
  }
  ConicSums less(const ConicSums& other) const {
    return {normal - other.normal, product - other.product};
  }
};

/// The outline's points about the blob's centre in units of its size, in the order of their angles.
struct Outline {
  Eigen::Vector2d centre;
  double size;
  std::vector<Eigen::Vector2d> points;
};

Outline outline_of(const Blob& blob) {
  Outline out{blob.ellipse.centre, size_of(blob.ellipse), {}};
  std::vector<std::pair<double, Eigen::Vector2d>> turned;
  for (const Eigen::Vector2d& point : blob.arc) {
    const Eigen::Vector2d p = (point - out.centre) / out.size;
    turned.emplace_back(std::atan2(p.y(), p.x()), p);
  }
  std::sort(turned.begin(), turned.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [angle, p] : turned) out.points.push_back(p);
  return out;
}

std::optional<EllipseShape> ellipse_of_sums(const ConicSums& sums) {
  const Conic k = sums.normal.ldlt().solve(sums.product);
  Eigen::Matrix2d Q;
  Q << k[0], 0.5 * k[1], 0.5 * k[1], k[2];
  if (!k.allFinite() || !(Q(0, 0) > 0.0 && Q.determinant() > 0.0)) return std::nullopt;
  const Eigen::Vector2d centre = -0.5 * Q.inverse() * k.tail<2>();
  return EllipseShape{centre, (1.0 + centre.dot(Q * centre)) * Q.inverse()};
}

// The share of the points that lie on the ellipse.
double share_on(const EllipseShape& shape, const Outline& outline) {
  const Eigen::Matrix2d inverse = shape.sigma.inverse();
  int on = 0;
  for (const Eigen::Vector2d& point : outline.points) {
    const double distance = depth_in(inverse, point - shape.centre);
    on += std::abs(distance) * outline.size < kOnOutline ? 1 : 0;
  }
  return static_cast<double>(on) / static_cast<double>(outline.points.size());
}

}  // namespace

std::optional<EllipseShape> covered_ellipse(const Blob& blob) {
  constexpr double kMostFill = 1.5;
  constexpr double kLeastFill = 0.6;
  if (blob.arc.size() < kLeastPoints || ellipse_of(blob.ellipse).b < kLeastAxis ||
      blob.fill < kLeastFill || blob.fill > kMostFill)
    return std::nullopt;
  const Outline outline = outline_of(blob);
  const std::size_t count = outline.points.size();
  // Sums up to each point, so that those of an arc are a difference.
  std::vector<ConicSums> up_to(count + 1);
  for (std::size_t k = 0; k < count; ++k) {
    up_to[k + 1] = up_to[k];
    up_to[k + 1].add(outline.points[k]);
  }
  std::optional<EllipseShape> best;
  double most = kLeastShare;
  constexpr std::size_t kTurns = 12;
  for (const double arc : {0.2, 0.35})
    for (std::size_t turn = 0; turn < kTurns; ++turn) {
      const auto left_out = static_cast<std::size_t>(arc * static_cast<double>(count));
      const std::size_t first = turn * count / kTurns;
      const std::size_t end = first + left_out;
      const ConicSums kept = end <= count ? up_to[count].less(up_to[end].less(up_to[first]))
                                          : up_to[first].less(up_to[end - count]);
      const auto shape = ellipse_of_sums(kept);
      if (!shape) continue;
      const double share = share_on(*shape, outline);
      if (share <= most) continue;
      most = share;
      best = shape;
    }
  if (!best) return std::nullopt;
  return EllipseShape{outline.centre + outline.size * best->centre,
                      outline.size * outline.size * best->sigma};
}

Blob doubled(const Blob& blob, const imaging::Window& window) {
  // Pixel k of the copy is the mean of pixels 2k and 2k + 1.
  const Eigen::Vector2d origin(window.u + 0.5, window.v + 0.5);
  Blob out = blob;
  out.box = {window.u + 2 * blob.box.u, window.v + 2 * blob.box.v, 2 * blob.box.width,
             2 * blob.box.height};
  out.area = 4.0 * blob.area;
  out.ellipse.centre = origin + 2.0 * blob.ellipse.centre;
  out.ellipse.sigma = 4.0 * blob.ellipse.sigma;
  out.outline = 2.0 * blob.outline;
  for (Eigen::Vector2d& point : out.arc) point = origin + 2.0 * point;
  return out;
}

}  // namespace vigia::tracking
