#include "vigia/localization/field_posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/Dense>

#include "vigia/core/angle.hpp"

namespace vigia::localization {
namespace {

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
    const Eigen::Vector3d off = basis * Eigen::Vector3d(site[0], site[1], site[2]);
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
  return {Pose2::from_vector(fix.pose.vector() + mean), squares / sum - mean * mean.transpose(),
          highest + std::log(sum * std::abs(basis.determinant())), static_cast<int>(nodes.size())};
}

}  // namespace vigia::localization
