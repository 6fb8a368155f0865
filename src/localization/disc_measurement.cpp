#include "vigia/localization/disc_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "vigia/localization/measurement_model.hpp"

namespace vigia::localization {
namespace {

constexpr int kDiscDof = 3;  // of (u, v, s)
/// σ of ln √(ab) that teaches nothing: a factor of e^1000.
constexpr double kUnmeasuredSize = 1e3;

/// A landmark that may be the one in the image.
struct DiscCandidate {
  const Landmark* landmark = nullptr;
  double nis = 0.0;
  double cost = 0.0;  ///< −2 ln likelihood up to a constant: NIS + ln det S
};

/// What is left of a measurement's covariance when the size is not to teach anything.
Eigen::Matrix3d without_size(Eigen::Matrix3d R) {
  R.row(2).setZero();
  R.col(2).setZero();
  R(2, 2) = kUnmeasuredSize * kUnmeasuredSize;
  return R;
}

Eigen::Matrix3d with_floor(Eigen::Matrix3d R, const MeasurementParams& params) {
  const Eigen::Vector3d floor(params.centre_floor_px, params.centre_floor_px, params.size_floor);
  R.diagonal() += floor.cwiseAbs2();
  return R;
}

/// The whole of what an ellipse says, size included, whichever landmark it shows.
struct Measured {
  Eigen::Vector3d z;
  Eigen::Matrix3d R;
};

Measured measured(const MeasurementModel& model, const EllipseObservation& observation) {
  return {measured_disc(observation),
          with_floor(measured_disc_covariance(observation), model.params())};
}

std::optional<Linearised<3>> linearise_as(const Landmark& landmark, const MeasurementModel& model,
                                          const Shot& shot, const Measured& measured,
                                          const Vector6& at) {
  const Eigen::Vector3d shared = model.look_biases(shot.camera).matrix();
  const auto image =
      predict_disc(landmark, shot, model.on_ground(), Pose2::from_vector(at.head<3>()),
                   {shared(0) * at(3), shared(1) * at(4), shared(2) * at(5)});
  if (!image) return std::nullopt;
  const double reading = model.params().sensor.reading_angle;
  const Eigen::Matrix<double, 3, 2> J = image->dz_dbias.leftCols<2>();
  Linearised<3> seen;
  seen.H << image->dz_dpose, image->dz_dbias;
  seen.y = measured.z - image->z;
  seen.R = measured.R + reading * reading * J * J.transpose();
  seen.H.rightCols<3>() = seen.H.rightCols<3>().eval() * shared.asDiagonal();
  return seen;
}

Eigen::Vector3d eye_at(const MeasurementModel& model, const Pose2& pose, const Shot& shot) {
  return model.on_ground().wMc(shot.camera, shot.head, pose).translation();
}

/// Whether the landmark is hidden from the believed pose and from all of the places two sigmas
/// around it: near the edge of a wall the belief cannot tell.
bool surely_hidden(const MeasurementModel& model, const LookState& state, const Shot& shot,
                   const Landmark& landmark) {
  const Eigen::Vector3d eye = eye_at(model, state.pose(), shot);
  if (!model.hides(eye, landmark.centre_w())) return false;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(state.covariance.topLeftCorner<2, 2>());
  const Eigen::Matrix<double, 3, 2> dp_dxy =
      model.on_ground().ground.dplace_dpose(state.pose()).topLeftCorner<3, 2>();
  for (Eigen::Index i = 0; i < 2; ++i) {
    const double sigma = std::sqrt(std::max(0.0, axes.eigenvalues()(i)));
    const Eigen::Vector3d step = dp_dxy * (2.0 * sigma * axes.eigenvectors().col(i));
    if (!model.hides(eye + step, landmark.centre_w()) ||
        !model.hides(eye - step, landmark.centre_w()))
      return false;
  }
  return true;
}

double log_det(const Eigen::LLT<Eigen::Matrix3d>& factor) {
  return 2.0 * Eigen::Matrix3d(factor.matrixL()).diagonal().array().log().sum();
}

DiscCandidate weigh(const Landmark& landmark, const Linearised<3>& seen, const LookState& state) {
  const Eigen::Matrix3d S = seen.H * state.covariance * seen.H.transpose() + seen.R;
  const auto factor = S.llt();
  const Eigen::Vector3d whitened = factor.matrixL().solve(seen.y);
  const double nis = whitened.squaredNorm();
  return {&landmark, nis, nis + log_det(factor)};
}

/// What the association weighs.
struct Candidates {
  std::vector<DiscCandidate> inside_gate;                     ///< best first
  double best_nis = std::numeric_limits<double>::infinity();  ///< inside the gate or not
  bool any_image = false;  ///< whether any landmark has an image from there at all
};

Candidates candidates(const MeasurementModel& model, const EllipseObservation& observation,
                      const LookState& state) {
  Candidates found;
  const double gate = model.gate(kDiscDof);
  const Measured ellipse = measured(model, observation);
  for (const Landmark& landmark : model.map().all()) {
    const auto seen = linearise_as(landmark, model, observation.shot, ellipse, state.mean);
    if (!seen) continue;
    const DiscCandidate candidate = weigh(landmark, *seen, state);
    if (!std::isfinite(candidate.cost)) continue;
    found.any_image = true;
    found.best_nis = std::min(found.best_nis, candidate.nis);
    if (candidate.nis > gate) continue;
    if (surely_hidden(model, state, observation.shot, landmark)) continue;
    found.inside_gate.push_back(candidate);
  }
  std::stable_sort(found.inside_gate.begin(), found.inside_gate.end(),
                   [](const DiscCandidate& a, const DiscCandidate& b) { return a.cost < b.cost; });
  return found;
}

}  // namespace

bool is_usable(const EllipseObservation& observation) {
  const Ellipse& e = observation.ellipse;
  return e.a > 0.0 && e.b > 0.0 && measured_disc(observation).allFinite() &&
         measured_disc_covariance(observation).allFinite();
}

AssociationOf<DiscMatch> associate(const MeasurementModel& model,
                                   const EllipseObservation& observation, const LookState& state) {
  const Candidates found = candidates(model, observation, state);
  if (!found.any_image) return {{UpdateStatus::degenerate, std::nullopt, 0.0, 0}, std::nullopt};
  if (found.inside_gate.empty())
    return {{UpdateStatus::gated, std::nullopt, found.best_nis, kDiscDof}, std::nullopt};
  const DiscCandidate& best = found.inside_gate.front();
  if (found.inside_gate.size() > 1 &&
      found.inside_gate[1].cost - best.cost < 2.0 * std::log(model.params().ambiguity_ratio))
    return {{UpdateStatus::ambiguous, std::nullopt, best.nis, kDiscDof}, std::nullopt};
  return {{UpdateStatus::fused, best.landmark->id, best.nis, kDiscDof},
          match(model, observation, *best.landmark)};
}

std::optional<DiscMatch> match(const MeasurementModel& model, const EllipseObservation& observation,
                               const Landmark& landmark) {
  if (!disc_radius(landmark)) return std::nullopt;
  const Measured whole = measured(model, observation);
  return DiscMatch{observation.shot, landmark, whole.z,
                   model.params().use_size ? whole.R : without_size(whole.R)};
}

std::optional<Linearised<3>> linearise(const MeasurementModel& model, const DiscMatch& match,
                                       const Vector6& at) {
  return linearise_as(match.landmark, model, match.shot, {match.z, match.R}, at);
}

std::optional<double> log_likelihood(const MeasurementModel& model,
                                     const EllipseObservation& observation, const Pose2& pose) {
  const Eigen::Matrix3d biases = look_covariance(model.params().sensor);
  const Eigen::Vector3d eye = eye_at(model, pose, observation.shot);
  std::optional<double> best;
  for (const Landmark& landmark : model.map().all()) {
    const auto known = match(model, observation, landmark);
    const auto seen = known ? linearise(model, *known, state_vector(pose)) : std::nullopt;
    if (!seen || model.hides(eye, landmark.centre_w())) continue;
    const auto factor = marginal_covariance(*seen, biases).llt();
    const Eigen::Vector3d whitened = factor.matrixL().solve(seen->y);
    const double value =
        -0.5 * (whitened.squaredNorm() + log_det(factor) + kDiscDof * std::log(2.0 * kPi));
    if (!best || value > *best) best = value;
  }
  return best;
}

}  // namespace vigia::localization
