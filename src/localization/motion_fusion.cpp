#include "vigia/localization/motion_fusion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Dense>

namespace vigia::localization {
namespace {

constexpr double kFlowSlack = 0.01;  // m, rad
constexpr double kShortWay_m = 1e-4;

bool stands(const OdometryIncrement& u) {
  return u.trans == 0.0 && u.rot1 == 0.0 && u.rot2 == 0.0;
}

double square(const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
  return off.dot(covariance.ldlt().solve(off));
}

/// The increment of a step, by a base that may go sideways if the one that was read did.
OdometryIncrement increment_of(const Pose2& step, const OdometryIncrement& read) {
  const auto make = read.crab != 0.0 ? &crab_increment : &chord_increment;
  return make({}, step, step.theta, read.from, read.to);
}

}  // namespace

Eigen::Matrix3d motion_covariance(const OdometryIncrement& read, const OdometryNoise& noise,
                                  const FlowMotion& seen) {
  const OdometryIncrement gone = increment_of(seen.step, read);
  const Eigen::Matrix3d G = move_jacobian_control({}, gone);
  return G * control_covariance(gone, noise) * G.transpose();
}

std::optional<FusedMotion> fuse_motions(const OdometryIncrement& read, const OdometryNoise& noise,
                                        const FlowMotion& seen, double gate) {
  const Pose2 by_wheels = move({}, read);
  const Eigen::Matrix3d P = motion_covariance(read, noise, seen);
  const Eigen::Vector3d off = difference(seen.step, by_wheels);
  if (stands(read) && square(off, seen.covariance) <= gate) return FusedMotion{};
  const Eigen::Matrix3d S = P + seen.covariance;
  if (square(off, S + kFlowSlack * kFlowSlack * Eigen::Matrix3d::Identity()) > gate)
    return std::nullopt;
  FusedMotion fused;
  fused.flow_weight = P * S.ldlt().solve(Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d L = Eigen::Matrix3d::Identity() - fused.flow_weight;
  fused.step = Pose2::from_vector(by_wheels.vector() + fused.flow_weight * off);
  fused.covariance =
      L * P * L.transpose() + fused.flow_weight * seen.covariance * fused.flow_weight.transpose();
  return fused;
}

OdometryIncrement joined(const std::vector<OdometryIncrement>& parts) {
  assert(!parts.empty());
  if (parts.size() == 1) return parts.front();
  Pose2 end;
  double turned = 0.0;
  bool sideways = false;
  for (const OdometryIncrement& part : parts) {
    end = move(end, part);
    turned += part.rot1 + part.rot2;
    sideways = sideways || part.crab != 0.0;
  }
  const auto make = sideways ? &crab_increment : &chord_increment;
  return make({}, end, turned, parts.front().from, parts.back().to);
}

OdometryIncrement as_increment(const FusedMotion& motion, const OdometryIncrement& read) {
  OdometryIncrement u = increment_of(motion.step, read);
  const Eigen::Matrix3d G = move_jacobian_control({}, u);
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> solver;
  solver.setThreshold(std::abs(u.trans) < kShortWay_m ? kShortWay_m : 1e-9);
  solver.compute(G);
  const Eigen::Matrix3d inverse = solver.pseudoInverse();
  u.covariance = inverse * motion.covariance * inverse.transpose();
  return u;
}

}  // namespace vigia::localization
