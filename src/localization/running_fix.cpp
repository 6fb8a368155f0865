#include "vigia/localization/running_fix.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

/// The displacement in world axes.
struct WorldDisplacement {
  Eigen::Vector2d d_w = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

WorldDisplacement displacement_in_world(const StationMotion& motion,
                                        const std::optional<HeadingPrior>& heading) {
  if (motion.frame == MotionFrame::world)
    return {motion.displacement_m, motion.covariance.topLeftCorner<2, 2>()};
  const Eigen::Vector2d ahead = unit_vector(heading->heading - motion.turn);
  Eigen::Matrix2d wRr;
  wRr << ahead.x(), -ahead.y(), ahead.y(), ahead.x();
  WorldDisplacement in_world{wRr * motion.displacement_m, {}};
  // By (dx, dy, turn) and the heading.
  const Eigen::Vector2d turned(-in_world.d_w.y(), in_world.d_w.x());
  Eigen::Matrix<double, 2, 3> J;
  J << wRr, -turned;
  in_world.covariance = J * motion.covariance * J.transpose() +
                        heading->sigma * heading->sigma * turned * turned.transpose();
  return in_world;
}

/// Covariance of (x, y, θ) at a candidate: |q − d| = r₁ and |q| = r₂ with q = p − l, θ by the
/// bearing from q.
Eigen::Matrix3d covariance_at(const RunningFixInput& input, const WorldDisplacement& d,
                              const Eigen::Vector2d& q) {
  const Eigen::Vector2d u1 = (q - d.d_w).normalized();
  const Eigen::Vector2d u2 = q.normalized();
  Eigen::Matrix2d U;
  U << u1.transpose(), u2.transpose();
  const Eigen::Matrix2d dq = U.inverse();
  const Eigen::RowVector2d dheading_dq = Eigen::RowVector2d(-q.y(), q.x()) / q.squaredNorm();
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();  // by (r₁, r₂, bearing)
  J.topLeftCorner<2, 2>() = dq;
  J.bottomLeftCorner<1, 2>() = dheading_dq * dq;
  J(2, 2) = -1.0;
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  noise(0, 0) = input.first.covariance(0, 0) + u1.dot(d.covariance * u1);
  noise.bottomRightCorner<2, 2>() = input.second.covariance;
  Eigen::Matrix3d covariance = J * noise * J.transpose();
  covariance.topLeftCorner<2, 2>() += input.landmark.covariance;
  return covariance;
}

PoseHypothesis candidate(const RunningFixInput& input, const WorldDisplacement& d,
                         const Eigen::Vector2d& q) {
  const Eigen::Vector2d p = input.landmark.p_w + q;
  const double heading = heading_by_landmark(input.landmark.p_w, p, input.second.bearing);
  return {{p.x(), p.y(), heading}, covariance_at(input, d, q), 0.5};
}

/// Up to a constant: log density of the candidate's difference from the prior.
double log_weight(const PoseHypothesis& candidate, const Prior& rough) {
  const Eigen::LDLT<Eigen::Matrix3d> spread(candidate.covariance + rough.covariance);
  const Eigen::Vector3d e = difference(candidate.pose, rough.pose);
  return -0.5 * (e.dot(spread.solve(e)) + spread.vectorD().array().log().sum());
}

/// Weights by the rough prior, or alike; the likelier first.
void weigh(std::vector<PoseHypothesis>& candidates, const std::optional<Prior>& rough) {
  std::vector<double> logs;
  logs.reserve(candidates.size());
  for (const PoseHypothesis& c : candidates) logs.push_back(rough ? log_weight(c, *rough) : 0.0);
  const double top = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (double& log : logs) sum += (log = std::exp(log - top));
  for (std::size_t i = 0; i < candidates.size(); ++i) candidates[i].weight = logs[i] / sum;
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.weight > b.weight; });
}

}  // namespace

double heading_by_landmark(const Eigen::Vector2d& landmark_w, const Eigen::Vector2d& p_w,
                           double bearing) {
  const Eigen::Vector2d to = landmark_w - p_w;
  return wrap_angle(std::atan2(to.y(), to.x()) - bearing);
}

RunningFix running_fix(const RunningFixInput& input, const std::optional<Prior>& rough,
                       const RunningFixParams& params) {
  RunningFix fix;
  fix.status = RunningFixStatus::no_heading;
  if (input.motion.frame == MotionFrame::body && !input.heading) return fix;
  const WorldDisplacement d = displacement_in_world(input.motion, input.heading);
  const double D = d.d_w.norm();
  const double r1 = input.first.range_m;
  const double r2 = input.second.range_m;
  fix.status = RunningFixStatus::degenerate;
  if (!(D > 1e-9)) return fix;
  const double a = (r2 * r2 - r1 * r1 + D * D) / (2.0 * D);
  const double h2 = r2 * r2 - a * a;
  fix.status = RunningFixStatus::circles_do_not_meet;
  if (h2 < 0.0) return fix;
  const double h = std::sqrt(h2);
  fix.sin_gamma = h * D / (r1 * r2);  // twice the triangle's area by two of its sides
  fix.status = RunningFixStatus::degenerate;
  if (!(fix.sin_gamma > 1e-9)) return fix;
  const Eigen::Vector2d along = d.d_w / D;
  const Eigen::Vector2d across(-along.y(), along.x());
  for (const double side : {1.0, -1.0})
    fix.candidates.push_back(candidate(input, d, a * along + side * h * across));
  weigh(fix.candidates, rough);
  if (fix.sin_gamma < params.min_sin_gamma) return fix;
  fix.status = fix.candidates.front().weight >= params.resolved ? RunningFixStatus::found
                                                                : RunningFixStatus::ambiguous;
  return fix;
}

}  // namespace vigia::localization
