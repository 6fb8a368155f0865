#include "known_walls.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/sector.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

constexpr double kSigmas = 4.0;
constexpr double kWidest = 0.7;  // rad, of a cone's half angle

double distance_from_origin(const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(-a.dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (a + t * ab).norm();
}

/// Whether the part of a segment inside the cone y ≤ |x·slope| has points at a distance from the
/// apex between @p nearest and @p farthest.
bool crosses_sector(const Vector2d& a, const Vector2d& b, double slope, double nearest,
                    double farthest) {
  double low = 0.0;
  double high = 1.0;
  if (!keep_positive(a.x() * slope - a.y(), b.x() * slope - b.y(), low, high)) return false;
  if (!keep_positive(a.x() * slope + a.y(), b.x() * slope + b.y(), low, high)) return false;
  const Vector2d p = a + low * (b - a);
  const Vector2d q = a + high * (b - a);
  return distance_from_origin(p, q) <= farthest && std::max(p.norm(), q.norm()) >= nearest;
}

}  // namespace

bool explained(const RangeReading& reading, const FloorPlan& plan, const Pose2& base,
               const PoseDoubt& doubt, double half_angle, double range_sigma_m) {
  const double slack = kSigmas * std::hypot(range_sigma_m, doubt.position_m);
  const double slope = std::tan(std::min(half_angle + kSigmas * doubt.heading, kWidest));
  const double angle = base.theta + reading.bearing;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const auto in_beam = [&](const Vector2d& p) {
    const Vector2d d = p - base.position();
    return Vector2d(c * d.x() + s * d.y(), -s * d.x() + c * d.y());
  };
  const double farthest = reading.range_m + slack;
  return std::any_of(plan.faces().begin(), plan.faces().end(), [&](const Wall& face) {
    return distance_to_segment(base.position(), face.a, face.b) <= farthest &&
           crosses_sector(in_beam(face.a), in_beam(face.b), slope, reading.range_m - slack,
                          farthest);
  });
}

}  // namespace vigia::pilot
