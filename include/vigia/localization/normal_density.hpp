#pragma once

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "vigia/core/angle.hpp"

namespace vigia::localization {

/// The density of a zero-mean normal variable of this variance at @p x.
inline double normal_density(double x, double variance) {
  return std::exp(-0.5 * x * x / variance) / std::sqrt(2.0 * kPi * variance);
}

/// Logarithm of the density of three zero-mean normal variables at @p off.
inline double log_normal_density(const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  const Eigen::Vector3d white = llt.matrixL().solve(off);
  const double log_root = llt.matrixLLT().diagonal().array().log().sum();
  return -0.5 * white.squaredNorm() - log_root - 1.5 * std::log(2.0 * kPi);
}

}  // namespace vigia::localization
