#include "vigia/localization/field_posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include "vigia/core/angle.hpp"

namespace vigia::localization {
namespace {

// Of the lattice against the fix, in steps. A sum with a node on a Gaussian's middle understates
// its variance, by 3 % at 1.7 σ a step, one midway overstates it; in between the first term of the
// error vanishes. A filter that sums at every update adds the error up.
constexpr double kShift = 0.25;

using LatticeSite = std::array<int, 3>;

/// What the lattice sums.
struct Node {
  Eigen::Vector3d off;  ///< from the fix
  double log_density;
};

/// Sites joined to the origin by sites whose log density is at most @p depth below the highest.
template <typename LogDensity>
std::vector<Node> grown_lattice(const Eigen::Matrix3d& basis, const FieldPosteriorParams& params,
                                const LogDensity& log_density) {
  std::vector<LatticeSite> queue{{0, 0, 0}};
  std::set<LatticeSite> seen(queue.begin(), queue.end());
  std::vector<Node> nodes;
  double highest = -1e300;
  for (std::size_t next = 0;
       next < queue.size() && nodes.size() < static_cast<std::size_t>(params.max_nodes); ++next) {
    const LatticeSite site = queue[next];
    const Eigen::Vector3d off =
        basis * Eigen::Vector3d(site[0] + kShift, site[1] + kShift, site[2] + kShift);
    nodes.push_back({off, log_density(off)});
    highest = std::max(highest, nodes.back().log_density);
    if (nodes.back().log_density < highest - params.depth) continue;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        LatticeSite neighbour = site;
        neighbour[axis] += step;
        if (seen.insert(neighbour).second) queue.push_back(neighbour);
      }
  }
  return nodes;
}

/// @p covariance with no variance below @p least in steps of the lattice: a hill that is narrower
/// than a step can lie between the nodes.
Eigen::Matrix3d not_narrower(const Eigen::Matrix3d& covariance, const Eigen::Matrix3d& basis,
                             double least) {
  const Eigen::Matrix3d into_steps = basis.inverse();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(into_steps * covariance * into_steps.transpose());
  const Eigen::Matrix3d root = basis * axes.eigenvectors();
  return root * axes.eigenvalues().cwiseMax(least).asDiagonal() * root.transpose();
}

}  // namespace

FieldPosterior posterior_about(const FieldModel& model, const std::vector<FieldPoint>& points,
                               const std::vector<StraightGroup>& groups, const FieldFix& fix,
                               const std::optional<Prior>& prior,
                               const FieldPosteriorParams& params) {
  Eigen::Matrix3d information = model.linearise(points, fix.pose, fix.clutter).complete;
  Eigen::Matrix3d prior_information = Eigen::Matrix3d::Zero();
  double log_norm = 0.0;
  if (prior) {
    prior_information = prior->covariance.inverse();
    log_norm = -0.5 * std::log((2.0 * kPi * prior->covariance).determinant());
  }
  information += prior_information + 1e-6 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d basis =
      params.step_sigmas * Eigen::Matrix3d(Eigen::Matrix3d(information.inverse()).llt().matrixL());
  const auto nodes = grown_lattice(basis, params, [&](const Eigen::Vector3d& off) {
    const Pose2 pose = Pose2::from_vector(fix.pose.vector() + off);
    const double log_likelihood = model.line_evidence(points, groups, pose, fix.clutter);
    if (!prior) return log_likelihood;
    const Eigen::Vector3d e = difference(pose, prior->pose);
    return log_likelihood + log_norm - 0.5 * e.dot(prior_information * e);
  });
  const double highest =
      std::max_element(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) {
        return a.log_density < b.log_density;
      })->log_density;
  double sum = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Node& node : nodes) {
    const double weight = std::exp(node.log_density - highest);
    sum += weight;
    mean += weight * node.off;
    squares += weight * node.off * node.off.transpose();
  }
  mean /= sum;
  const Eigen::Matrix3d covariance = squares / sum - mean * mean.transpose();
  return {Pose2::from_vector(fix.pose.vector() + mean),
          not_narrower(covariance, basis, 1.0 / (params.step_sigmas * params.step_sigmas)),
          highest + std::log(sum * std::abs(basis.determinant())), static_cast<int>(nodes.size())};
}

}  // namespace vigia::localization
