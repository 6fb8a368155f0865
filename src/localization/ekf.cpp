#include "vigia/localization/ekf.hpp"

#include "association.hpp"
#include "look_smoother.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "vigia/localization/chi_square.hpp"

namespace vigia::localization {
namespace {

constexpr int kDof = 3;  // of (u, v, s)
/// σ of ln √(ab) that teaches nothing: a factor of e^1000.
constexpr double kUnmeasuredSize = 1e3;
/// A look without an image for so long (s) is not linearised anew any more.
constexpr double kLookPause = 1.0;
/// Of a look of more events the older half is not linearised anew any more.
constexpr std::size_t kLookEvents = 250;

double fraction_at(const OdometryIncrement& u, Stamp stamp) {
  return (stamp - u.from).seconds() / (u.to - u.from).seconds();
}

/// What is left of a measurement's covariance when the size is not to teach anything.
Eigen::Matrix3d without_size(Eigen::Matrix3d R) {
  R.row(2).setZero();
  R.col(2).setZero();
  R(2, 2) = kUnmeasuredSize * kUnmeasuredSize;
  return R;
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
  horizon_ = stamp;
  rejections_ = 0;
  rejected_looks_.clear();
  first_nis_.clear();
  said_lost_ = false;
  refresh_belief();
}

void EkfLocalizer::lose() {
  said_lost_ = true;
  refresh_belief();
}

void EkfLocalizer::predict(const OdometryIncrement& increment) {
  assert(std::isfinite(increment.rot1 + increment.trans + increment.rot2));
  const std::vector<DiscFix> ahead = drop_extrapolated();
  append(increment);
  for (const DiscFix& fix : ahead) {
    const std::vector<Event> later = roll_back(fix.sensor.stamp);
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
  if (stamp < horizon_) return {UpdateStatus::too_late, std::nullopt, 0.0, 0};
  const std::vector<Event> later = roll_back(stamp);
  const bool first_of_look = state().look != observation.sensor.look;
  const UpdateResult result = match(observation, with_look(state(), observation.sensor.look));
  const Eigen::Matrix3d R = measurement_covariance(observation);
  if (result.status == UpdateStatus::fused)
    append(DiscFix{observation.sensor, *map_.find(*result.landmark), measured_disc(observation),
                   params_.use_size ? R : without_size(R)});
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

void EkfLocalizer::append(const EkfInput& input, bool extrapolated) {
  Event event{input, extrapolated, state(), events_.empty() ? Window{} : events_.back().window};
  if (const auto* increment = std::get_if<OdometryIncrement>(&input))
    move_by(*increment, event);
  else
    fuse(std::get<DiscFix>(input), event);
  assert(event.after.mean.allFinite() && event.after.covariance.allFinite());
  events_.push_back(std::move(event));
}

void EkfLocalizer::move_by(const OdometryIncrement& increment, Event& event) const {
  event.after = propagate(event.after, increment, params_.odometry);
  Window& window = event.window;
  if (window.events > 0) ++window.events;
  if ((increment.to - window.last_image).seconds() > kLookPause) window = {};
}

void EkfLocalizer::fuse(const DiscFix& fix, Event& event) const {
  Window& window = event.window;
  event.after = with_look(event.after, fix.sensor.look);
  if (window.events == 0 || window.start.look != fix.sensor.look) {
    window = {};
    window.start = event.after;
  }
  ++window.events;
  ++window.images;
  window.last_image = fix.sensor.stamp;
  auto smoothed = smooth_look(window.start, inputs_of_look(event), guess_of_look(event),
                              {geometry_, params_.sensor, params_.odometry}, params_.iterations,
                              params_.converged);
  if (!smoothed) {
    window = {};
    return;
  }
  event.after = smoothed->filtered.back();
  window.trajectory = std::move(smoothed->trajectory);
  if (window.events > kLookEvents) {
    const auto half = static_cast<std::ptrdiff_t>(window.events / 2);
    window.start = smoothed->filtered[static_cast<std::size_t>(half) - 1];
    window.trajectory.erase(window.trajectory.begin(), window.trajectory.begin() + half);
    window.events = window.trajectory.size();
    window.images =
        1 + static_cast<int>(std::count_if(
                events_.end() - static_cast<std::ptrdiff_t>(window.events - 1), events_.end(),
                [](const Event& e) { return std::holds_alternative<DiscFix>(e.input); }));
  }
}

std::vector<const EkfInput*> EkfLocalizer::inputs_of_look(const Event& event) const {
  const Window& window = event.window;
  int stride = 1;
  while (window.images > stride * params_.look_images) stride *= 2;
  std::vector<const EkfInput*> inputs;
  int image = 0;
  for (auto it = events_.end() - static_cast<std::ptrdiff_t>(window.events - 1);
       it != events_.end(); ++it) {
    const bool left_out = std::holds_alternative<DiscFix>(it->input) && image++ % stride != 0;
    inputs.push_back(left_out ? nullptr : &it->input);
  }
  inputs.push_back(&event.input);
  return inputs;
}

std::vector<Vector6> EkfLocalizer::guess_of_look(const Event& event) const {
  // As last smoothed; of what came since, as filtered.
  std::vector<Vector6> guess = event.window.trajectory;
  const std::size_t first = events_.size() + 1 - event.window.events;
  for (std::size_t k = guess.size(); k < event.window.events; ++k)
    guess.push_back(k == 0 ? event.window.start.mean : events_[first + k - 1].after.mean);
  return guess;
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

std::vector<DiscFix> EkfLocalizer::drop_extrapolated() {
  const auto first = std::find_if(events_.begin(), events_.end(),
                                  [](const Event& event) { return event.extrapolated; });
  std::vector<DiscFix> fixes;
  for (auto it = first; it != events_.end(); ++it)
    if (const auto* fix = std::get_if<DiscFix>(&it->input)) fixes.push_back(*fix);
  events_.erase(first, events_.end());
  return fixes;
}

void EkfLocalizer::forget_old() {
  const Stamp oldest = state().stamp - Duration::from_seconds(params_.history_s);
  const auto last = std::prev(events_.end());
  const auto kept = std::find_if(events_.begin(), last, [oldest](const Event& event) {
    return !(event.after.stamp < oldest);
  });
  if (kept == events_.begin()) return;
  // A return to the horizon needs the look that was under way there.
  const Event& before = *std::prev(kept);
  horizon_ = before.after.stamp;
  auto forgotten = (kept - events_.begin()) - static_cast<std::ptrdiff_t>(before.window.events);
  for (; forgotten > 0; --forgotten) {
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
  said_lost_ = said_lost_ || rejected || unlikely;
}

void EkfLocalizer::refresh_belief() {
  const EkfState& now = state();
  belief_.stamp = now.stamp;
  belief_.pose = now.pose();
  belief_.covariance = now.pose_covariance();
  const bool lost = said_lost_ || belief_.position_sigma() > params_.lost_sigma_m;
  belief_.status = lost ? BeliefStatus::lost : BeliefStatus::tracking;
}

}  // namespace vigia::localization
