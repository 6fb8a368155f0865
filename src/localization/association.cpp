#include "association.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace vigia::localization {
namespace {

/// Whether the landmark is hidden from the believed pose and from all of the places two sigmas
/// around it: near the edge of a wall the belief cannot tell.
bool surely_hidden(const AssociationModel& model, const EkfState& state, const Shot& shot,
                   const Landmark& landmark) {
  if (model.plan == nullptr) return false;
  const Eigen::Isometry3d wMc = model.on_ground.wMc(shot.camera, shot.head, state.pose());
  if (model.plan->line_of_sight(wMc.translation(), landmark.centre_w())) return false;
  const Eigen::Matrix<double, 3, 2> dp_dxy =
      model.on_ground.ground.dplace_dpose(state.pose()).topLeftCorner<3, 2>();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(state.covariance.topLeftCorner<2, 2>());
  for (Eigen::Index i = 0; i < 2; ++i) {
    const double sigma = std::sqrt(std::max(0.0, axes.eigenvalues()(i)));
    const Eigen::Vector3d step = dp_dxy * (2.0 * sigma * axes.eigenvectors().col(i));
    if (model.plan->line_of_sight(wMc.translation() + step, landmark.centre_w()) ||
        model.plan->line_of_sight(wMc.translation() - step, landmark.centre_w()))
      return false;
  }
  return true;
}

Candidate weigh(const Landmark& landmark, const DiscMeasurement& predicted,
                const AssociationModel& model, const EkfState& state, const Eigen::Vector3d& z,
                const Eigen::Matrix3d& R) {
  const Matrix36 H = state_jacobian(predicted);
  const Eigen::Matrix3d S =
      H * state.covariance * H.transpose() + R + reading_covariance(predicted, model.noise);
  const auto factor = S.llt();
  const Eigen::Vector3d whitened = factor.matrixL().solve(z - predicted.z);
  const double nis = whitened.squaredNorm();
  const double log_det = 2.0 * Eigen::Matrix3d(factor.matrixL()).diagonal().array().log().sum();
  return {&landmark, nis, nis + log_det};
}

}  // namespace

Association associate(const AssociationModel& model, const EkfState& state,
                      const EllipseObservation& observation, const Eigen::Vector3d& z,
                      const Eigen::Matrix3d& R) {
  Association association;
  association.best_nis = std::numeric_limits<double>::infinity();
  for (const Landmark& landmark : model.map.all()) {
    const auto predicted =
        predict_disc(landmark, observation.shot, model.on_ground, state.pose(), state.bias());
    if (!predicted) continue;
    const Candidate candidate = weigh(landmark, *predicted, model, state, z, R);
    if (!std::isfinite(candidate.cost)) continue;
    association.any_image = true;
    association.best_nis = std::min(association.best_nis, candidate.nis);
    if (candidate.nis > model.gate) continue;
    if (surely_hidden(model, state, observation.shot, landmark)) continue;
    association.inside_gate.push_back(candidate);
  }
  std::stable_sort(association.inside_gate.begin(), association.inside_gate.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return association;
}

}  // namespace vigia::localization
