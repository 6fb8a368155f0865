#include "vigia/localization/ekf.hpp"

#include "association.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "vigia/localization/chi_square.hpp"

namespace vigia::localization {
namespace {

constexpr int kDof = 3;  // of (u, v, s)
/// An update whose step is below this (m, rad) has converged.
constexpr double kConverged = 1e-7;

double fraction_at(const OdometryIncrement& u, Stamp stamp) {
  return (stamp - u.from).seconds() / (u.to - u.from).seconds();
}

bool is_usable(const EllipseObservation& observation) {
  const Ellipse& e = observation.ellipse;
  return e.a > 0.0 && e.b > 0.0 && measured_disc(observation).allFinite() &&
         measured_disc_covariance(observation).allFinite();
}

}  // namespace

EkfLocalizer::EkfLocalizer(LandmarkMap map, const HeadGeometry& geometry, const EkfParams& params,
                           std::optional<FloorPlan> plan)
    : map_(std::move(map)),
      geometry_(geometry),
      params_(params),
      plan_(std::move(plan)),
      gate_(chi_square_quantile(params.gate_probability, kDof)),
      nis_limit_(chi_square_quantile(1.0 - params.nis_probability, kDof * params.nis_looks)) {
  reset(Stamp{}, Prior{});
}

void EkfLocalizer::reset(Stamp stamp, const Prior& prior) {
  base_ = initial_state(stamp, prior, params_.sensor);
  events_.clear();
  rejections_ = 0;
  rejected_looks_.clear();
  first_nis_.clear();
  innovations_say_lost_ = false;
  refresh_belief();
}

void EkfLocalizer::predict(const OdometryIncrement& increment) {
  assert(std::isfinite(increment.rot1 + increment.trans + increment.rot2));
  const std::vector<Fix> ahead = drop_extrapolated();
  append(increment);
  for (const Fix& fix : ahead) {
    const std::vector<Event> later = roll_back(fix.observation.sensor.stamp);
    append(fix);
    for (const Event& event : later) append(event.input, event.extrapolated);
  }
  forget_old();
  refresh_belief();
}

UpdateResult EkfLocalizer::update(const Observation& observation) {
  UpdateResult result;
  if (const auto* disc = std::get_if<EllipseObservation>(&observation)) result = update_disc(*disc);
  ++counts_[static_cast<std::size_t>(result.status)];
  refresh_belief();
  return result;
}

UpdateResult EkfLocalizer::update_disc(const EllipseObservation& observation) {
  const Stamp stamp = observation.sensor.stamp;
  if (!is_usable(observation)) return {UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  if (stamp < base_.stamp) return {UpdateStatus::too_late, std::nullopt, 0.0, 0};
  const std::vector<Event> later = roll_back(stamp);
  const bool first_of_look = state().look != observation.sensor.look;
  const UpdateResult result = match(observation, with_look(state(), observation.sensor.look));
  if (result.status == UpdateStatus::fused)
    append(Fix{observation, *result.landmark});
  else if (!events_.empty() && events_.back().extrapolated)
    events_.pop_back();
  for (const Event& event : later) append(event.input, event.extrapolated);
  watch_innovations(result, observation.sensor.look, first_of_look);
  return result;
}

UpdateResult EkfLocalizer::match(const EllipseObservation& observation, const EkfState& at) const {
  const AssociationModel model{map_, plan_ ? &*plan_ : nullptr, geometry_, params_.sensor, gate_};
  const Association found = associate(model, at, observation, measured_disc(observation),
                                      measurement_covariance(observation));
  if (!found.any_image) return {UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  if (found.inside_gate.empty()) return {UpdateStatus::gated, std::nullopt, found.best_nis, kDof};
  const Candidate& best = found.inside_gate.front();
  if (found.inside_gate.size() > 1 &&
      found.inside_gate[1].cost - best.cost < 2.0 * std::log(params_.ambiguity_ratio))
    return {UpdateStatus::ambiguous, std::nullopt, best.nis, kDof};
  return {UpdateStatus::fused, best.landmark->id, best.nis, kDof};
}

void EkfLocalizer::append(const std::variant<OdometryIncrement, Fix>& input, bool extrapolated) {
  Event event{input, extrapolated, {}};
  if (const auto* increment = std::get_if<OdometryIncrement>(&input))
    event.after = propagate(state(), *increment, params_.odometry);
  else
    event.after = fuse(state(), std::get<Fix>(input));
  assert(event.after.mean.allFinite() && event.after.covariance.allFinite());
  events_.push_back(std::move(event));
}

EkfState EkfLocalizer::with_look(const EkfState& state, LookId look) const {
  return state.look == look ? state : begin_look(state, look, params_.sensor);
}

Eigen::Matrix3d EkfLocalizer::measurement_covariance(const EllipseObservation& observation) const {
  const Eigen::Vector3d floor(params_.centre_floor_px, params_.centre_floor_px, params_.size_floor);
  Eigen::Matrix3d R = measured_disc_covariance(observation);
  R.diagonal() += floor.cwiseAbs2();
  return R;
}

EkfState EkfLocalizer::fuse(const EkfState& before, const Fix& fix) const {
  const SensorSnapshot& sensor = fix.observation.sensor;
  const EkfState prior = with_look(before, sensor.look);
  const Eigen::Vector3d z = measured_disc(fix.observation);
  const Eigen::Matrix3d R0 = measurement_covariance(fix.observation);
  EkfState posterior = prior;
  for (int i = 0; i < params_.iterations; ++i) {
    const auto predicted = predict_disc(*map_.find(fix.landmark), sensor, geometry_,
                                        posterior.pose(), posterior.bias());
    if (!predicted) break;
    // Iterated EKF: linearised at the last estimate, weighed against the prior.
    const Matrix36 H = state_jacobian(*predicted);
    const Eigen::Matrix3d R = R0 + reading_covariance(*predicted, params_.sensor);
    const Eigen::Matrix<double, 6, 3> K = kalman_gain(prior.covariance, H, R);
    Vector6 moved = posterior.mean - prior.mean;
    moved(2) = wrap_angle(moved(2));
    const Vector6 step = K * (z - predicted->z + H * moved) - moved;
    posterior.mean += step;
    posterior.covariance = joseph_update(prior.covariance, H, K, R);
    if (step.cwiseAbs().maxCoeff() < kConverged) break;
  }
  posterior.mean.head<3>() = posterior.pose().vector();
  posterior.stamp = std::max(before.stamp, sensor.stamp);
  return posterior;
}

std::vector<EkfLocalizer::Event> EkfLocalizer::roll_back(Stamp stamp) {
  std::vector<Event> later;
  while (!events_.empty() && stamp < events_.back().after.stamp) {
    later.push_back(std::move(events_.back()));
    events_.pop_back();
  }
  std::reverse(later.begin(), later.end());
  if (later.empty()) {
    if (state().stamp < stamp) extrapolate(stamp);
    return later;
  }
  if (auto* increment = std::get_if<OdometryIncrement>(&later.front().input)) {
    const OdometryIncrement whole = *increment;
    if (whole.from < stamp) {
      const double f = fraction_at(whole, stamp);
      OdometryIncrement before = first_part(whole, f);
      before.to = stamp;
      append(before, later.front().extrapolated);
      *increment = second_part(whole, f);
      increment->from = stamp;
    }
  }
  return later;
}

void EkfLocalizer::extrapolate(Stamp stamp) {
  OdometryIncrement motion{state().stamp, stamp, 0.0, 0.0, 0.0};
  const auto last = std::find_if(events_.rbegin(), events_.rend(), [](const Event& event) {
    return std::holds_alternative<OdometryIncrement>(event.input);
  });
  if (last != events_.rend()) {
    const auto& u = std::get<OdometryIncrement>(last->input);
    if (u.from < u.to)
      motion = first_part(u, (stamp - motion.from).seconds() / (u.to - u.from).seconds());
    motion.from = state().stamp;
    motion.to = stamp;
  }
  append(motion, true);
}

std::vector<EkfLocalizer::Fix> EkfLocalizer::drop_extrapolated() {
  const auto first = std::find_if(events_.begin(), events_.end(),
                                  [](const Event& event) { return event.extrapolated; });
  std::vector<Fix> fixes;
  for (auto it = first; it != events_.end(); ++it)
    if (const auto* fix = std::get_if<Fix>(&it->input)) fixes.push_back(*fix);
  events_.erase(first, events_.end());
  return fixes;
}

void EkfLocalizer::forget_old() {
  const Stamp horizon = state().stamp - Duration::from_seconds(params_.history_s);
  while (events_.size() > 1 && events_.front().after.stamp < horizon) {
    base_ = std::move(events_.front().after);
    events_.pop_front();
  }
}

void EkfLocalizer::watch_innovations(const UpdateResult& result, LookId look, bool first_of_look) {
  if (result.status == UpdateStatus::gated || result.status == UpdateStatus::degenerate) {
    ++rejections_;
    rejected_looks_.insert(look);
  }
  if (result.status == UpdateStatus::fused) {
    rejections_ = 0;
    rejected_looks_.clear();
    if (first_of_look) first_nis_.push_back(result.nis);
    if (first_nis_.size() > static_cast<std::size_t>(params_.nis_looks)) first_nis_.pop_front();
  }
  const bool rejected = rejections_ >= params_.lost_rejections &&
                        rejected_looks_.size() >= static_cast<std::size_t>(params_.lost_looks);
  const bool unlikely = std::accumulate(first_nis_.begin(), first_nis_.end(), 0.0) > nis_limit_;
  innovations_say_lost_ = innovations_say_lost_ || rejected || unlikely;
}

void EkfLocalizer::refresh_belief() {
  const EkfState& now = state();
  belief_.stamp = now.stamp;
  belief_.pose = now.pose();
  belief_.covariance = now.pose_covariance();
  const bool lost = innovations_say_lost_ || belief_.position_sigma() > params_.lost_sigma_m;
  belief_.status = lost ? BeliefStatus::lost : BeliefStatus::tracking;
}

}  // namespace vigia::localization
