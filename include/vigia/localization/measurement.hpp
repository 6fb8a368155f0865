#pragma once

#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "vigia/localization/localizer.hpp"
#include "vigia/localization/look_state.hpp"

namespace vigia::localization {

class MeasurementModel;

/// What a matched image says of the state (x, y, θ, pan, tilt, log focal) near the point x where it
/// is linearised: y = H (truth − x) + e, e ~ N(0, R), R with the white part of the readings. An
/// image that says more than six numbers is compressed to six without loss for the state; what they
/// leave out is the scatter.
template <int Rows>
struct Linearised {
  Eigen::Matrix<double, Rows, 6> H;
  Eigen::Matrix<double, Rows, 1> y;
  Eigen::Matrix<double, Rows, Rows> R;
  int rank = Rows;       ///< directions of the state that the image measures
  double scatter = 0.0;  ///< χ² that no state near x takes away
  int scatter_dof = 0;
};

/// R + J B Jᵀ: the covariance of y where the biases are not estimated but have covariance @p
/// biases.
template <int Rows>
Eigen::Matrix<double, Rows, Rows> marginal_covariance(const Linearised<Rows>& seen,
                                                      const Eigen::Matrix3d& biases) {
  const Eigen::Matrix<double, Rows, 3> J = seen.H.template rightCols<3>();
  return seen.R + J * biases * J.transpose();
}

/// ∂y/∂(x, y, θ).
template <int Rows>
Eigen::Matrix<double, Rows, 3> pose_jacobian(const Linearised<Rows>& seen) {
  return seen.H.template leftCols<3>();
}

/// The covariance after the image, P − K S Kᵀ in Joseph's form, symmetrised; S = H P Hᵀ + R must be
/// positive definite.
template <int Rows>
Matrix6 updated_covariance(const Matrix6& covariance, const Linearised<Rows>& seen) {
  const Eigen::Matrix<double, Rows, 6> HP = seen.H * covariance;
  const Eigen::Matrix<double, Rows, Rows> S = HP * seen.H.transpose() + seen.R;
  const Eigen::Matrix<double, 6, Rows> K = S.ldlt().solve(HP).transpose();
  const Matrix6 I_KH = Matrix6::Identity() - K * seen.H;
  const Matrix6 updated = I_KH * covariance * I_KH.transpose() + K * seen.R * K.transpose();
  return 0.5 * (updated + updated.transpose());
}

/// What an association found: the result, and, where its status is `fused`, the matched image.
template <typename M>
struct AssociationOf {
  UpdateResult result;
  std::optional<M> match;
};

}  // namespace vigia::localization
