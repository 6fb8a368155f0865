#include "label_placer.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::report {
namespace {

bool overlap(const Box& a, const Box& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

bool inside(const Box& box, const Eigen::Vector2d& p) {
  return p.x() > box.x && p.x() < box.right() && p.y() > box.y && p.y() < box.bottom();
}

bool inside(const Box& outer, const Box& inner) {
  return inner.x >= outer.x && inner.y >= outer.y && inner.right() <= outer.right() &&
         inner.bottom() <= outer.bottom();
}

// The box in direction u that clears the anchor by the gap.
Box beside(const Eigen::Vector2d& anchor, const Eigen::Vector2d& size, double gap,
           const Eigen::Vector2d& u) {
  const Eigen::Vector2d centre =
      anchor + gap * u + 0.5 * size.cwiseProduct(u / std::max(std::abs(u.x()), std::abs(u.y())));
  return {centre.x() - 0.5 * size.x(), centre.y() - 0.5 * size.y(), size.x(), size.y()};
}

}  // namespace

std::optional<double> LabelPlacer::cost(const Box& box) const {
  if (!inside(bounds_, box)) return std::nullopt;
  for (const Box& other : taken_)
    if (overlap(box, other)) return std::nullopt;
  return static_cast<double>(std::count_if(
      points_.begin(), points_.end(), [&](const Eigen::Vector2d& p) { return inside(box, p); }));
}

std::optional<Box> LabelPlacer::place(const Eigen::Vector2d& anchor, const Eigen::Vector2d& size,
                                      double gap, const Eigen::Vector2d& preferred) {
  constexpr int kDirections = 16;
  std::optional<Box> best;
  double best_cost = 0.0;
  for (int ring = 0; ring < 3; ++ring) {
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * M_PI * i / kDirections;
      const Eigen::Vector2d u = unit_vector(angle);
      const Box box = beside(anchor, size, gap * (1 + ring), u);
      const std::optional<double> points = cost(box);
      if (!points) continue;
      const double total = *points + 1.5 * ring + 1.0 - u.dot(preferred);
      if (best && total >= best_cost) continue;
      best = box;
      best_cost = total;
    }
  }
  if (best) block(*best);
  return best;
}

}  // namespace vigia::report
