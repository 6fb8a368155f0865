#include "vigia/core/sector.hpp"

#include "face_ray.hpp"

#include <algorithm>
#include <limits>

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

NearFaces::NearFaces(const FloorPlan& plan, const Eigen::Vector2d& origin, double reach_m,
                     double above_m)
    : plan_(&plan), origin_(origin), reach_m_(reach_m) {
  constexpr double kSlack_m = 1e-6;  // more than rounding takes off a distance
  for (const Wall& face : plan.faces()) {
    if (face.height_m <= above_m) continue;
    if (distance_to_segment(origin, face.a, face.b) > reach_m + kSlack_m) continue;
    sides_.push_back({&face, face.a - origin, face.b - origin});
  }
}

std::optional<double> NearFaces::nearest_in(const Sector& sector) const {
  double nearest = reach_m_;
  bool echo = false;
  for (const Side& side : sides_) {
    const auto distance = segment_in_sector(sector, side.a, side.b);
    if (!distance || *distance > nearest) continue;
    nearest = *distance;
    echo = true;
  }
  return echo ? std::optional(nearest) : std::nullopt;
}

std::optional<RayHit> NearFaces::cast(const Eigen::Vector2d& direction, double max_m) const {
  RayHit nearest{std::numeric_limits<double>::infinity(), 0, 0.0};
  for (const Side& side : sides_) {
    const double distance = ray_distance(origin_, direction, *side.face);
    if (distance < nearest.distance_m)
      nearest = {distance, static_cast<std::size_t>(side.face - plan_->faces().data()), 0.0};
  }
  return nearest.distance_m <= max_m ? std::optional(nearest) : std::nullopt;
}

std::optional<double> nearest_face(const FloorPlan& plan, const Eigen::Vector2d& p,
                                   const Sector& sector, double reach_m, double above_m) {
  return NearFaces(plan, p, reach_m, above_m).nearest_in(sector);
}

}  // namespace vigia
