#include "tag_coverage.hpp"

#include "rays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::sim {
namespace {

using imaging::kTagFields;

/// A polygon of at most eight corners: a quadrilateral cut by four half planes.
struct Polygon {
  std::array<Eigen::Vector2d, 8> corners;
  std::size_t count = 0;

  void add(const Eigen::Vector2d& corner) { corners[count++] = corner; }
  const Eigen::Vector2d& next(std::size_t i) const { return corners[i + 1 < count ? i + 1 : 0]; }
};

double area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Eigen::Vector2d a = polygon.corners[i] - polygon.corners[0];
    const Eigen::Vector2d b = polygon.next(i) - polygon.corners[0];
    twice += cross(a, b);
  }
  return 0.5 * std::abs(twice);
}

/// The part of the polygon where side · (p[axis] − edge) ≥ 0.
Polygon cut(const Polygon& polygon, int axis, double edge, double side) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Eigen::Vector2d& a = polygon.corners[i];
    const Eigen::Vector2d& b = polygon.next(i);
    const double from = side * (a[axis] - edge);
    const double to = side * (b[axis] - edge);
    if (from >= 0.0) part.add(a);
    if ((from < 0.0) != (to < 0.0)) part.add(a + from / (from - to) * (b - a));
  }
  return part;
}

double area_in_field(const Polygon& pixel, int column, int row) {
  Polygon part = cut(pixel, 0, column, 1.0);
  part = cut(part, 0, column + 1.0, -1.0);
  part = cut(part, 1, row, 1.0);
  return area(cut(part, 1, row + 1.0, -1.0));
}

/// Share of a pixel, given in columns and rows of fields, that is black.
double black_share(const imaging::TagBitmap& black, const Polygon& pixel) {
  Eigen::Array2d low = pixel.corners[0];
  Eigen::Array2d high = low;
  for (std::size_t i = 1; i < pixel.count; ++i) {
    low = low.min(pixel.corners[i].array());
    high = high.max(pixel.corners[i].array());
  }
  if ((high <= 0.0).any() || (low >= kTagFields).any()) return 0.0;
  const auto first = [](double value) { return std::max(0, static_cast<int>(std::floor(value))); };
  const auto last = [](double value) {
    return std::min(kTagFields - 1, static_cast<int>(std::ceil(value)) - 1);
  };
  const auto is_black = [&](int column, int row) {
    return black[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
  };
  const bool within = (low >= 0.0).all() && (high <= kTagFields).all();
  if (within && first(low.x()) == last(high.x()) && first(low.y()) == last(high.y()))
    return is_black(first(low.x()), first(low.y())) ? 1.0 : 0.0;
  double covered = 0.0;
  for (int row = first(low.y()); row <= last(high.y()); ++row)
    for (int column = first(low.x()); column <= last(high.x()); ++column)
      if (is_black(column, row)) covered += area_in_field(pixel, column, row);
  return std::min(1.0, covered / area(pixel));
}

/// Where the corners above and left of the pixels of row @p v lie, in columns and rows of fields;
/// not a number where the ray does not meet the plane in front.
void corner_row(const Eigen::Matrix3d& dHray, const CameraModel& model, int first_u, int v,
                std::vector<Eigen::Vector2d>& corners) {
  int u = first_u;
  for (Eigen::Vector2d& corner : corners) {
    const Eigen::Vector3d p = dHray * point_ray(model, {u++ - 0.5, v - 0.5});
    corner = p.z() > 0.0 ? Eigen::Vector2d(0.5 * kTagFields * (1.0 + p.x() / p.z()),
                                           0.5 * kTagFields * (1.0 - p.y() / p.z()))
                         : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace

std::vector<float> tag_coverage(const imaging::TagBitmap& black, const Eigen::Matrix3d& dHray,
                                const CameraModel& model, const imaging::Window& window) {
  const auto width = static_cast<std::size_t>(window.width);
  std::vector<float> coverage(width * static_cast<std::size_t>(window.height));
  std::vector<Eigen::Vector2d> above(width + 1);
  std::vector<Eigen::Vector2d> below(width + 1);
  corner_row(dHray, model, window.u, window.v, below);
  float* out = coverage.data();
  for (int v = window.v; v < window.bottom(); ++v) {
    above.swap(below);
    corner_row(dHray, model, window.u, v + 1, below);
    for (std::size_t i = 0; i < width; ++i, ++out) {
      Polygon pixel;
      for (const auto& corner : {above[i], above[i + 1], below[i + 1], below[i]}) pixel.add(corner);
      const bool seen = std::all_of(pixel.corners.begin(), pixel.corners.begin() + 4,
                                    [](const Eigen::Vector2d& p) { return p.allFinite(); });
      if (seen) *out = static_cast<float>(black_share(black, pixel));
    }
  }
  return coverage;
}

}  // namespace vigia::sim
