#include "vigia/localization/points_measurement.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vigia/localization/measurement_model.hpp"

namespace vigia::localization {
namespace {

constexpr int kExplainSteps = 20;
/// A turn about the camera with the pan turned back leaves no trace.
constexpr int kMaxRank = 5;
constexpr double kExplainConverged = 1e-7;  // m, rad

/// The state that explains both the points and what was known, and how well.
struct Explanation {
  Vector6 mean;
  double nis = 0.0;
  double scatter = 0.0;
  int scatter_dof = 0;
  int rank = 0;
};

/// Nothing when a point has no image on the way or the steps do not converge.
std::optional<Explanation> explain(const MeasurementModel& model, const LookState& state,
                                   const PointsMatch& match) {
  Explanation found;
  found.mean = state.mean;
  for (int i = 0; i < kExplainSteps; ++i) {
    const auto seen = linearise(model, match, found.mean);
    if (!seen) return std::nullopt;
    const Matrix6 HP = seen->H * state.covariance;
    const Eigen::LLT<Matrix6> S(HP * seen->H.transpose() + seen->R);
    const Vector6 innovation = seen->y - seen->H * (state.mean - found.mean);
    const Vector6 weighted = S.solve(innovation);
    const Vector6 next = state.mean + HP.transpose() * weighted;
    const double step = (next - found.mean).cwiseAbs().maxCoeff();
    found = {next, innovation.dot(weighted), seen->scatter, seen->scatter_dof, seen->rank};
    if (!(step < 1e6)) return std::nullopt;
    if (step < kExplainConverged) return found;
  }
  return std::nullopt;
}

}  // namespace

bool is_usable(const PointsObservation& observation) {
  return !observation.points.empty();
}

AssociationOf<PointsMatch> associate(const MeasurementModel& model,
                                     const PointsObservation& observation, const LookState& state) {
  const Landmark* landmark = model.map().find(observation.landmark);
  if (landmark == nullptr) return {{UpdateStatus::gated, std::nullopt, 0.0, 0}, std::nullopt};
  auto named = match(model, observation, *landmark);
  if (!named) return {{UpdateStatus::degenerate, std::nullopt, 0.0, 0}, std::nullopt};
  const auto found = explain(model, state, *named);
  if (!found) return {{UpdateStatus::degenerate, landmark->id, 0.0, 0}, std::nullopt};
  const bool expected = found->nis <= model.gate(found->rank);
  const bool tidy = found->scatter_dof <= 0 || found->scatter <= model.gate(found->scatter_dof);
  UpdateResult result{UpdateStatus::gated, landmark->id, found->nis, found->rank};
  if (!expected || !tidy) return {result, std::nullopt};
  result.status = UpdateStatus::fused;
  return {result, std::move(named)};
}

std::optional<PointsMatch> match(const MeasurementModel& model,
                                 const PointsObservation& observation, const Landmark& landmark) {
  PointsMatch match{observation.shot, landmark,
                    seen_points(landmark, observation, model.params().centre_floor_px)};
  if (match.points.empty()) return std::nullopt;
  return match;
}

std::optional<Linearised<6>> linearise(const MeasurementModel& model, const PointsMatch& match,
                                       const Vector6& at) {
  const Eigen::Vector3d shared = model.look_biases(match.shot.camera).matrix();
  const auto image = measure_points(match.points, match.landmark.wMl, match.shot, model.on_ground(),
                                    Pose2::from_vector(at.head<3>()),
                                    {shared(0) * at(3), shared(1) * at(4), shared(2) * at(5)});
  if (!image) return std::nullopt;
  const double reading = model.params().sensor.reading_angle;
  const Eigen::Matrix<double, 6, 2> J = image->H.middleCols<2>(3);
  Linearised<6> seen;
  seen.H = image->H;
  seen.y = image->y;
  seen.R = Matrix6::Identity() + reading * reading * J * J.transpose();
  const auto measured = (image->H.rowwise().squaredNorm().array() > 0.0).count();
  seen.rank = std::min(kMaxRank, static_cast<int>(measured));
  seen.scatter = image->chi2 - image->y.squaredNorm();
  seen.scatter_dof = 2 * static_cast<int>(match.points.size()) - seen.rank;
  seen.H.rightCols<3>() = seen.H.rightCols<3>().eval() * shared.asDiagonal();
  return seen;
}

std::optional<double> log_likelihood(const MeasurementModel& model,
                                     const PointsObservation& observation, const Pose2& pose) {
  const Landmark* landmark = model.map().find(observation.landmark);
  if (landmark == nullptr) return std::nullopt;
  const auto named = match(model, observation, *landmark);
  const auto seen = named ? linearise(model, *named, state_vector(pose)) : std::nullopt;
  if (!seen) return std::nullopt;
  const auto factor = marginal_covariance(*seen, look_covariance(model.params().sensor)).llt();
  const Vector6 whitened = factor.matrixL().solve(seen->y);
  double log_det = 2.0 * Matrix6(factor.matrixL()).diagonal().array().log().sum();
  for (const SeenPoint& point : named->points)
    log_det += 2.0 * std::log(2.0 * kPi) - std::log(point.information.determinant());
  return -0.5 * (whitened.squaredNorm() + seen->scatter + log_det);
}

}  // namespace vigia::localization
