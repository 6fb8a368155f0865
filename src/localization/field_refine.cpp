#include "vigia/localization/field_refine.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Dense>

#include "vigia/core/angle.hpp"

namespace vigia::localization {
namespace {

constexpr double kLeastInformation = 1.0;  // 1/m², 1/rad²: below, the points do not fix the pose
constexpr double kLeastShare = 0.15;  // of the complete information that the observed one keeps
constexpr double kMinClutter = 0.005;
constexpr double kMaxClutter = 0.9;

/// The prior as information about a deviation from its mean.
struct PriorTerm {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double log_norm = 0.0;

  explicit PriorTerm(const std::optional<Prior>& prior) {
    if (!prior) return;
    information = prior->covariance.inverse();
    mean = prior->pose.vector();
    log_norm = -0.5 * std::log((2.0 * kPi * prior->covariance).determinant());
  }
  Eigen::Vector3d off(const Pose2& pose) const {
    Eigen::Vector3d off = pose.vector() - mean;
    off.z() = wrap_angle(off.z());
    return off;
  }
  double log_density(const Pose2& pose) const {
    const Eigen::Vector3d e = off(pose);
    return log_norm - 0.5 * e.dot(information * e);
  }
};

/// The sums at a pose, the prior's among them.
FieldLinearisation linearise_with(const FieldModel& model, const std::vector<FieldPoint>& points,
                                  const PriorTerm& prior, const Pose2& pose, double clutter,
                                  double spread_m) {
  FieldLinearisation at = model.linearise(points, pose, clutter, spread_m);
  at.log_likelihood += prior.log_density(pose);
  at.gradient -= prior.information * prior.off(pose);
  at.complete += prior.information;
  at.observed += prior.information;
  return at;
}

bool is_positive(const Eigen::Matrix3d& m) {
  return Eigen::LLT<Eigen::Matrix3d>(m).info() == Eigen::Success;
}

/// What the points say about the pose: the observed information where it is sound.
Eigen::Matrix3d sound_information(const FieldLinearisation& at) {
  return is_positive(at.observed - kLeastShare * at.complete) ? at.observed
                                                              : Eigen::Matrix3d(0.5 * at.complete);
}

Eigen::Vector3d limited_step(const FieldLinearisation& at, const FieldRefineParams& params) {
  const Eigen::Matrix3d information =
      is_positive(at.observed - kLeastShare * at.complete) ? at.observed : at.complete;
  Eigen::Vector3d step =
      (information + 1e-6 * Eigen::Matrix3d::Identity()).ldlt().solve(at.gradient);
  const double too_far =
      std::max(step.head<2>().norm() / params.max_step_m, std::abs(step.z()) / params.max_step_rad);
  if (too_far > 1.0) step /= too_far;
  return step;
}

double estimated_clutter(const FieldLinearisation& at, std::size_t points, double assumed,
                         double prior_points) {
  const double off = static_cast<double>(points) - at.on_lines + assumed * prior_points;
  return std::clamp(off / (static_cast<double>(points) + prior_points), kMinClutter, kMaxClutter);
}

void finish(const FieldLinearisation& at, FieldFix& fix) {
  fix.log_likelihood = at.log_likelihood;
  fix.on_lines = at.on_lines;
  const Eigen::Matrix3d information = sound_information(at);
  if (!is_positive(information - kLeastInformation * Eigen::Matrix3d::Identity())) {
    fix.status = FieldFixStatus::degenerate;
    return;
  }
  fix.covariance = information.inverse();
}

}  // namespace

FieldFix refine_field_pose(const FieldModel& model, const std::vector<FieldPoint>& points,
                           const Pose2& start, const std::optional<Prior>& prior,
                           const FieldRefineParams& params) {
  const PriorTerm prior_term(prior);
  FieldFix fix;
  fix.status = FieldFixStatus::not_converged;
  fix.pose = start;
  fix.clutter = params.clutter.value_or(model.params().clutter);
  double spread = params.spread_m;
  const auto linearise = [&](const Pose2& pose) {
    return linearise_with(model, points, prior_term, pose, fix.clutter, spread);
  };
  FieldLinearisation at = linearise(fix.pose);
  for (; fix.iterations < params.iterations; ++fix.iterations) {
    Eigen::Vector3d step = limited_step(at, params);
    FieldLinearisation next;
    Pose2 moved;
    for (int halved = 0; halved < 4; ++halved, step *= 0.5) {
      moved = Pose2::from_vector(fix.pose.vector() + step);
      next = linearise(moved);
      if (next.log_likelihood >= at.log_likelihood - 1e-9) break;
    }
    fix.pose = moved;
    at = next;
    const bool arrived = step.norm() < params.converged && spread == 0.0;
    double changed = 0.0;
    if (!params.clutter) {
      const double clutter =
          estimated_clutter(at, points.size(), model.params().clutter, params.prior_points);
      changed = std::abs(clutter - fix.clutter);
      fix.clutter = clutter;
    }
    spread = spread > 0.02 ? 0.5 * spread : 0.0;
    if (arrived && changed < 0.01) {
      fix.status = FieldFixStatus::converged;
      break;
    }
    at = linearise(fix.pose);
  }
  finish(at, fix);
  fix.log_prior = prior_term.log_density(fix.pose);
  fix.log_likelihood -= fix.log_prior;
  return fix;
}

double log_evidence_of(const FieldModel& model, const FieldScan& scan,
                       const std::vector<StraightGroup>& groups, const FieldFix& fix,
                       double clutter) {
  const double log_volume = 0.5 * std::log((2.0 * kPi * fix.covariance).determinant());
  return model.line_evidence(scan.points, groups, fix.pose, clutter) +
         model.log_likelihood_of_sightings(scan, fix.pose) + fix.log_prior + log_volume;
}

}  // namespace vigia::localization
