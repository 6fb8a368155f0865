#include "vigia/pilot/contact_risk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

constexpr double kContactInSigmas = 3.0;
constexpr double kNeverTouches = std::numeric_limits<double>::infinity();

/// Along the unit vector @p ahead, until a point comes as near as @p radius.
double travel_to_point(const Vector2d& from, const Vector2d& ahead, const Vector2d& point,
                       double radius) {
  const Vector2d d = point - from;
  const double beside = cross(ahead, d);
  const double along = ahead.dot(d);
  if (std::abs(beside) >= radius || along <= 0.0) return kNeverTouches;
  return std::max(0.0, along - std::sqrt(radius * radius - beside * beside));
}

/// Along the unit vector @p ahead, until a disc touches the face; of one that touches it already
/// and goes away from it, infinite.
double travel_to_face(const Vector2d& from, const Vector2d& ahead, const Wall& face,
                      double radius) {
  double nearest = std::min(travel_to_point(from, ahead, face.a, radius),
                            travel_to_point(from, ahead, face.b, radius));
  const Vector2d along = (face.b - face.a).normalized();
  Vector2d normal(-along.y(), along.x());
  if (normal.dot(from - face.a) < 0.0) normal = -normal;
  const double nearing = -normal.dot(ahead);
  if (nearing <= 0.0) return nearest;
  const double travel = std::max(0.0, (normal.dot(from - face.a) - radius) / nearing);
  const double foot = along.dot(from + travel * ahead - face.a);
  if (foot >= 0.0 && foot <= (face.b - face.a).norm()) nearest = std::min(nearest, travel);
  return nearest;
}

double widest_sigma(const Eigen::Matrix3d& covariance) {
  const double mean = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double beside = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(std::max(0.0, mean + std::hypot(beside, covariance(0, 1))));
}

}  // namespace

ContactRisk::ContactRisk(const FloorPlan& plan, double robot_radius_m, double risk)
    : plan_(plan), radius_m_(robot_radius_m), risk_(risk) {}

double ContactRisk::free_from(const PoseHypothesis& hypothesis, double turn,
                              double horizon_m) const {
  const Vector2d from = hypothesis.pose.position();
  const double nearer = kContactInSigmas * widest_sigma(hypothesis.covariance);
  if (plan_.clearance(from) <= 0.0) return horizon_m;
  const Vector2d ahead = unit_vector(hypothesis.pose.theta + turn);
  double travel = kNeverTouches;
  for (const Wall& face : plan_.faces())
    travel = std::min(travel, travel_to_face(from, ahead, face, radius_m_));
  return std::clamp(travel - nearer, 0.0, horizon_m);
}

double ContactRisk::free_m(const Belief& belief, double turn, double horizon_m) const {
  if (belief.hypotheses.empty())
    return free_from({belief.pose, belief.covariance, 1.0}, turn, horizon_m);
  std::vector<std::pair<double, double>> touches;  // after so many metres, of that weight
  for (const PoseHypothesis& hypothesis : belief.hypotheses) {
    const double free = free_from(hypothesis, turn, horizon_m);
    if (free < horizon_m) touches.emplace_back(free, hypothesis.weight);
  }
  std::sort(touches.begin(), touches.end());
  double weight = 0.0;
  for (const auto& [free, share] : touches) {
    weight += share;
    if (weight > risk_) return free;
  }
  return horizon_m;
}

}  // namespace vigia::pilot
