#include "vigia/core/sector.hpp"

#include <algorithm>

namespace vigia {
namespace {

/// Distance from the sector's tip to the part of the segment ab inside it.
std::optional<double> segment_in_sector(const Sector& sector, const Eigen::Vector2d& a,
                                        const Eigen::Vector2d& b) {
  double low = 0.0;
  double high = 1.0;
  if (!keep_positive(cross(sector.right, a), cross(sector.right, b), low, high))
    return std::nullopt;
  if (!keep_positive(-cross(sector.left, a), -cross(sector.left, b), low, high))
    return std::nullopt;
  const Eigen::Vector2d ab = b - a;
  const double nearest = std::clamp(-a.dot(ab) / ab.squaredNorm(), low, high);
  return (a + nearest * ab).norm();
}

}  // namespace

bool keep_positive(double at_a, double at_b, double& low, double& high) {
  if (at_a < 0.0 && at_b < 0.0) return false;
  if (at_a >= 0.0 && at_b >= 0.0) return true;
  const double at = at_a / (at_a - at_b);
  if (at_a < 0.0)
    low = std::max(low, at);
  else
    high = std::min(high, at);
  return low <= high;
}

std::optional<double> nearest_face(const FloorPlan& plan, const Eigen::Vector2d& p,
                                   const Sector& sector, double reach_m, double above_m) {
  double nearest = reach_m;
  bool echo = false;
  for (const Wall& face : plan.faces()) {
    if (face.height_m <= above_m) continue;
    const auto distance = segment_in_sector(sector, face.a - p, face.b - p);
    if (!distance || *distance > nearest) continue;
    nearest = *distance;
    echo = true;
  }
  return echo ? std::optional(nearest) : std::nullopt;
}

}  // namespace vigia
