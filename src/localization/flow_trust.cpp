#include "vigia/localization/flow_trust.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/localization/motion_fusion.hpp"

namespace vigia::localization {
namespace {

constexpr double kTrustMemory_s = 5.0;
constexpr double kTrustSlack = 0.01;  // m, rad

}  // namespace

bool FlowTrust::holds(const OdometryIncrement& read, const OdometryNoise& noise,
                      const FlowMotion& seen, const Eigen::Matrix3d& errors, double gate) {
  const double kept = std::exp(-(read.to - read.from).seconds() / kTrustMemory_s);
  difference_ = kept * difference_ + difference(seen.step, move({}, read));
  covariance_ = kept * kept * covariance_ + motion_covariance(read, noise, seen) + seen.covariance;
  derrors_ = kept * derrors_ + seen.derrors;
  const Eigen::Matrix3d S = covariance_ + derrors_ * errors * derrors_.transpose() +
                            kTrustSlack * kTrustSlack * Eigen::Matrix3d::Identity();
  return difference_.dot(S.ldlt().solve(difference_)) <= gate;
}

}  // namespace vigia::localization
