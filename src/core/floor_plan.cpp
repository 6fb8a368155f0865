#include "vigia/core/floor_plan.hpp"

#include "face_ray.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "vigia/core/plane_geometry.hpp"

namespace vigia {
namespace {

constexpr double kOnFace = 1e-3;  // a landmark this near to a face lies on it
constexpr double kSeam = 1e-9;  // faces are this much longer, so that no ray slips through a corner

void append_sides(std::vector<Wall>& faces, const std::vector<Eigen::Vector2d>& polygon,
                  double height_m) {
  if (polygon.size() < 3) throw std::invalid_argument("a polygon needs at least three corners");
  for (std::size_t i = 0; i < polygon.size(); ++i)
    faces.push_back({polygon[i], polygon[(i + 1) % polygon.size()], height_m});
}

/// Whether the point at a fraction of the way along a face lies on it.
bool on_face(const Wall& face, double fraction) {
  const double slack = kSeam / (face.b - face.a).norm();
  return fraction >= -slack && fraction <= 1.0 + slack;
}

/// Whether a face stands between two points, neither of which lies on it.
bool hides(const Wall& face, const Eigen::Vector3d& p_w, const Eigen::Vector3d& q_w) {
  const Eigen::Vector2d p = p_w.head<2>();
  const Eigen::Vector2d q = q_w.head<2>();
  const auto crossing = cross_lines(p, q, face.a, face.b);
  if (!crossing || crossing->along_pq <= 0.0 || crossing->along_pq >= 1.0) return false;
  if (!on_face(face, crossing->along_ab)) return false;
  if (p_w.z() + crossing->along_pq * (q_w.z() - p_w.z()) > face.height_m) return false;
  return distance_to_segment(p, face.a, face.b) > kOnFace &&
         distance_to_segment(q, face.a, face.b) > kOnFace;
}

}  // namespace

double ray_distance(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                    const Wall& face) {
  constexpr double kMissed = std::numeric_limits<double>::infinity();
  constexpr double kClear = 1e-6;  // m, well beyond kSeam
  const double right_of_a = cross(direction, face.a - origin);
  const double right_of_b = cross(direction, face.b - origin);
  if (std::min(right_of_a, right_of_b) > kClear || std::max(right_of_a, right_of_b) < -kClear)
    return kMissed;
  const auto crossing = cross_lines(origin, origin + direction, face.a, face.b);
  if (crossing) {
    const bool met = crossing->along_pq >= -kSeam && on_face(face, crossing->along_ab);
    return met ? std::max(0.0, crossing->along_pq) : kMissed;
  }
  if (std::abs(right_of_a) > kSeam) return kMissed;
  const auto [low, high] =
      std::minmax({direction.dot(face.a - origin), direction.dot(face.b - origin)});
  return high < 0.0 ? kMissed : std::max(0.0, low);
}

FloorPlan::FloorPlan(std::vector<Eigen::Vector2d> outline, double ceiling_m,
                     std::vector<Wall> partitions, std::vector<Obstacle> obstacles)
    : outline_(std::move(outline)),
      ceiling_m_(ceiling_m),
      partitions_(std::move(partitions)),
      obstacles_(std::move(obstacles)) {
  append_sides(faces_, outline_, ceiling_m_);
  faces_.insert(faces_.end(), partitions_.begin(), partitions_.end());
  for (const Obstacle& obstacle : obstacles_)
    append_sides(faces_, obstacle.polygon, obstacle.height_m);
  for (const Wall& face : faces_) {
    // Written so that NaN fails.
    if (!((face.b - face.a).norm() > kSeam)) throw std::invalid_argument("a wall has no length");
    if (!(face.height_m > 0.0)) throw std::invalid_argument("a wall has no height");
  }
}

std::optional<RayHit> FloorPlan::cast(const Eigen::Vector2d& origin,
                                      const Eigen::Vector2d& direction, double max_m,
                                      double above_m) const {
  RayHit nearest{std::numeric_limits<double>::infinity(), 0, 0.0};
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (faces_[i].height_m <= above_m) continue;
    const double distance = ray_distance(origin, direction, faces_[i]);
    if (distance < nearest.distance_m) nearest = {distance, i, 0.0};
  }
  if (nearest.distance_m > max_m || std::isinf(nearest.distance_m)) return std::nullopt;
  const Wall& face = faces_[nearest.wall];
  const Eigen::Vector2d along = face.b - face.a;
  const Eigen::Vector2d met = origin + nearest.distance_m * direction;
  nearest.along_m = std::clamp((met - face.a).dot(along.normalized()), 0.0, along.norm());
  return nearest;
}

bool FloorPlan::line_of_sight(const Eigen::Vector3d& p_w, const Eigen::Vector3d& q_w) const {
  return std::none_of(faces_.begin(), faces_.end(),
                      [&](const Wall& face) { return hides(face, p_w, q_w); });
}

double FloorPlan::clearance(const Eigen::Vector2d& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& face : faces_)
    nearest = std::min(nearest, distance_to_segment(p, face.a, face.b));
  const bool outside = !outline_.empty() && !inside_polygon(p, outline_);
  const bool in_solid =
      std::any_of(obstacles_.begin(), obstacles_.end(),
                  [&p](const Obstacle& solid) { return inside_polygon(p, solid.polygon); });
  return outside || in_solid ? -nearest : nearest;
}

Eigen::Vector2d FloorPlan::min_corner() const {
  Eigen::Vector2d corner = outline_.empty() ? Eigen::Vector2d(0.0, 0.0) : outline_.front();
  for (const Eigen::Vector2d& p : outline_) corner = corner.cwiseMin(p);
  return corner;
}

Eigen::Vector2d FloorPlan::max_corner() const {
  Eigen::Vector2d corner = outline_.empty() ? Eigen::Vector2d(0.0, 0.0) : outline_.front();
  for (const Eigen::Vector2d& p : outline_) corner = corner.cwiseMax(p);
  return corner;
}

}  // namespace vigia
