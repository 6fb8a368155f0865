#include "ellipse_shape.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

// Variance of an angle that is uniform over half a turn.
const double kUniformAngleVariance = kPi * kPi / 12.0;

// Where the row v cuts the ellipse: the half length of the chord and its middle.
struct Chord {
  double middle;
  double half;  // negative: no cut
};

Chord chord_of(const EllipseShape& shape, double v) {
  const double dv = v - shape.centre.y();
  const double p = shape.sigma(0, 0);
  const double q = shape.sigma(0, 1);
  const double r = shape.sigma(1, 1);
  const double inside = 1.0 - dv * dv / r;
  if (inside < 0.0) return {0.0, -1.0};
  return {shape.centre.x() + q / r * dv, std::sqrt((p - q * q / r) * inside)};
}

// The ellipse of the same directions with both axes longer by @p margin (shorter if negative).
EllipseShape grown(const EllipseShape& shape, double margin) {
  Ellipse ellipse = ellipse_of(shape);
  ellipse.a += margin;
  ellipse.b += margin;
  return shape_of(ellipse);
}

}  // namespace

EllipseShape shape_of(const Ellipse& ellipse) {
  const double c = std::cos(ellipse.psi);
  const double s = std::sin(ellipse.psi);
  const double aa = ellipse.a * ellipse.a;
  const double bb = ellipse.b * ellipse.b;
  EllipseShape shape;
  shape.centre << ellipse.u, ellipse.v;
  const double mixed = (aa - bb) * c * s;
  shape.sigma << aa * c * c + bb * s * s, mixed, mixed, aa * s * s + bb * c * c;
  return shape;
}

Ellipse ellipse_of(const EllipseShape& shape) {
  const double p = shape.sigma(0, 0);
  const double q = shape.sigma(0, 1);
  const double r = shape.sigma(1, 1);
  const double mean = 0.5 * (p + r);
  const double radius = std::hypot(0.5 * (p - r), q);
  double psi = radius > 0.0 ? 0.5 * std::atan2(2.0 * q, p - r) : 0.0;
  if (psi <= -kPi / 2.0) psi += kPi;
  return {shape.centre.x(), shape.centre.y(), std::sqrt(mean + radius),
          std::sqrt(std::max(0.0, mean - radius)), psi};
}

double size_of(const EllipseShape& shape) {
  return std::sqrt(std::sqrt(shape.sigma.determinant()));
}

double depth_in(const Eigen::Matrix2d& inverse, const Eigen::Vector2d& offset) {
  const Eigen::Vector2d gradient = inverse * offset;
  const double level = std::sqrt(offset.dot(gradient));
  return (1.0 - level) * level / std::max(gradient.norm(), 1e-9);
}

Eigen::Vector2d half_extent(const EllipseShape& shape) {
  return {std::sqrt(shape.sigma(0, 0)), std::sqrt(shape.sigma(1, 1))};
}

imaging::Window window_round(const EllipseShape& shape, double margin) {
  const Eigen::Vector2d half = half_extent(shape) + Eigen::Vector2d::Constant(margin);
  const int left = static_cast<int>(std::floor(shape.centre.x() - half.x()));
  const int top = static_cast<int>(std::floor(shape.centre.y() - half.y()));
  const int right = static_cast<int>(std::ceil(shape.centre.x() + half.x()));
  const int bottom = static_cast<int>(std::ceil(shape.centre.y() + half.y()));
  return {left, top, right - left + 1, bottom - top + 1};
}

bool band_has_hole(const Ellipse& ellipse, double half_width) {
  return ellipse.b > half_width + 0.5;
}

std::vector<BandRow> band_rows(const EllipseShape& shape, double half_width) {
  const EllipseShape outer = grown(shape, half_width);
  const bool has_hole = band_has_hole(ellipse_of(shape), half_width);
  const EllipseShape inner = has_hole ? grown(shape, -half_width) : shape;
  const imaging::Window rows = window_round(outer, 0.0);
  std::vector<BandRow> band;
  band.reserve(static_cast<std::size_t>(rows.height));
  for (int v = rows.v; v < rows.bottom(); ++v) {
    const Chord whole = chord_of(outer, v);
    if (whole.half < 0.0) continue;
    const int first = static_cast<int>(std::ceil(whole.middle - whole.half));
    const int last = static_cast<int>(std::floor(whole.middle + whole.half));
    if (last < first) continue;
    const Chord hole = has_hole ? chord_of(inner, v) : Chord{0.0, -1.0};
    if (hole.half < 0.0)
      band.push_back({v, first, last + 1, last, last});
    else
      band.push_back({v, first, static_cast<int>(std::ceil(hole.middle - hole.half)),
                      static_cast<int>(std::floor(hole.middle + hole.half)), last});
  }
  return band;
}

EllipseEstimate estimate_of(const EllipseShape& shape,
                            const Eigen::Matrix<double, 5, 5>& covariance) {
  EllipseEstimate estimate;
  Ellipse& e = estimate.ellipse;
  e = ellipse_of(shape);
  const double c = std::cos(e.psi);
  const double s = std::sin(e.psi);

  // dΣ seen from the axes: along a, along b, and across (which turns them).
  Eigen::Matrix<double, 5, 5> jacobian = Eigen::Matrix<double, 5, 5>::Identity();
  jacobian.row(2) << 0.0, 0.0, c * c, 2.0 * c * s, s * s;
  jacobian.row(3) << 0.0, 0.0, s * s, -2.0 * c * s, c * c;
  jacobian.row(4) << 0.0, 0.0, -c * s, c * c - s * s, c * s;
  jacobian.row(2) /= 2.0 * e.a;
  jacobian.row(3) /= 2.0 * e.b;
  jacobian.row(4) /= e.a + e.b;  // now px: (a − b) dψ
  Eigen::Matrix<double, 5, 5>& out = estimate.covariance;
  out = jacobian * covariance * jacobian.transpose();

  const double across_variance = out(4, 4);
  const double half_difference = 0.5 * (e.a - e.b);
  const double mean = 0.5 * (e.a + e.b);
  const double unbiased =
      std::sqrt(std::max(0.0, half_difference * half_difference - across_variance));
  e.a = mean + unbiased;
  e.b = mean - unbiased;

  const double difference = 2.0 * half_difference;
  const double psi_variance =
      1.0 / (difference * difference / across_variance + 1.0 / kUniformAngleVariance);
  const double scale = std::sqrt(psi_variance / across_variance);
  out.row(4) *= scale;
  out.col(4) *= scale;
  return estimate;
}

}  // namespace vigia::tracking
