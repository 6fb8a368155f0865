#include "vigia/core/plane_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vigia {
namespace {

constexpr double kTouch = 1e-9;  // metres

}  // namespace

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

std::optional<Crossing> cross_lines(const Eigen::Vector2d& p, const Eigen::Vector2d& q,
                                    const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d pq = q - p;
  const Eigen::Vector2d ab = b - a;
  const double sine = cross(pq, ab);
  if (std::abs(sine) <= 1e-12 * pq.norm() * ab.norm()) return std::nullopt;
  return Crossing{cross(a - p, ab) / sine, cross(a - p, pq) / sine};
}

bool segments_meet(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& a,
                   const Eigen::Vector2d& b) {
  const auto crossing = cross_lines(p, q, a, b);
  const auto within = [](double t) { return t >= 0.0 && t <= 1.0; };
  if (crossing && within(crossing->along_pq) && within(crossing->along_ab)) return true;
  return std::min({distance_to_segment(p, a, b), distance_to_segment(q, a, b),
                   distance_to_segment(a, p, q), distance_to_segment(b, p, q)}) <= kTouch;
}

bool inside_polygon(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& polygon) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

double polygon_area(const std::vector<Eigen::Vector2d>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * std::abs(twice);
}

double distance_to_outline(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& polygon) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    nearest =
        std::min(nearest, distance_to_segment(p, polygon[i], polygon[(i + 1) % polygon.size()]));
  return nearest;
}

std::optional<std::pair<std::size_t, std::size_t>> crossing_sides(
    const std::vector<Eigen::Vector2d>& polygon) {
  const std::size_t n = polygon.size();
  const auto corner = [&](std::size_t i) -> const Eigen::Vector2d& { return polygon[i % n]; };
  for (std::size_t i = 0; i < n; ++i) {
    // Neighbours share a corner; they cross only when one folds back onto the other.
    const Eigen::Vector2d in = corner(i + 1) - corner(i);
    const Eigen::Vector2d out = corner(i + 2) - corner(i + 1);
    if (std::abs(cross(in, out)) <= kTouch * std::max(in.norm(), out.norm()) && in.dot(out) < 0.0)
      return std::pair{i, (i + 1) % n};
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (segments_meet(corner(i), corner(i + 1), corner(j), corner(j + 1))) return std::pair{i, j};
    }
  }
  return std::nullopt;
}

}  // namespace vigia
