#include "vigia/localization/ekf.hpp"

#include "association.hpp"
#include "look_smoother.hpp"
#include "points_gate.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "vigia/localization/chi_square.hpp"

namespace vigia::localization {
namespace {

constexpr int kDof = 3;        // of (u, v, s)
constexpr int kPointsDof = 5;  // at most, of what points say about the state
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

bool is_usable(const PointsObservation& observation) {
  return !observation.points.empty();
}

bool is_image(const EkfInput& input) {
  return shot_of(input) != nullptr;
}

}  // namespace

EkfLocalizer::EkfLocalizer(LandmarkMap map, const RigOnGround& on_ground, const EkfParams& params,
                           std::optional<FloorPlan> plan)
    : map_(std::move(map)),
      on_ground_(on_ground),
      params_(params),
      plan_(std::move(plan)),
      gate_(chi_square_quantile(params.gate_probability, kDof)),
      nis_limits_(static_cast<std::size_t>(kPointsDof * params.nis_looks) + 1),
      mean_speed_(params.odometry) {
  for (std::size_t dof = 1; dof < nis_limits_.size(); ++dof)
    nis_limits_[dof] = chi_square_quantile(1.0 - params.nis_probability, static_cast<double>(dof));
  reset(Stamp{}, Prior{});
}

void EkfLocalizer::reset(Stamp stamp, const Prior& prior) {
  base_ = initial_state(stamp, prior, params_.sensor);
  events_.clear();
  mean_speed_.reset();
  horizon_ = stamp;
  rejections_ = 0;
  rejected_looks_.clear();
  first_of_looks_.clear();
  said_lost_ = false;
  refresh_belief();
}

void EkfLocalizer::lose() {
  said_lost_ = true;
  refresh_belief();
}

void EkfLocalizer::predict(const OdometryIncrement& increment) {
  assert(std::isfinite(increment.rot1 + increment.trans + increment.rot2));
  const std::vector<EkfInput> ahead = drop_extrapolated();
  append(Motion{increment, mean_speed_.even(increment)});
  for (const EkfInput& fix : ahead) {
    const std::vector<Event> later = roll_back(shot_of(fix)->stamp);
    append(fix);
    for (const Event& event : later) append(event.input, event.extrapolated);
  }
  forget_old();
  refresh_belief();
}

UpdateResult EkfLocalizer::update(const Observation& observation) {
  const bool usable = std::visit([](const auto& seen) { return is_usable(seen); }, observation);
  UpdateResult result{UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  if (usable) result = take_in(observation);
  ++counts_[static_cast<std::size_t>(result.status)];
  refresh_belief();
  return result;
}

UpdateResult EkfLocalizer::take_in(const Observation& observation) {
  const Shot& shot = vigia::shot_of(observation);
  if (shot.stamp < horizon_) return {UpdateStatus::too_late, std::nullopt, 0.0, 0};
  const std::vector<Event> later = roll_back(shot.stamp);
  const bool first_of_look = state().look != shot.look;
  const EkfState at = with_look(state(), shot.look);
  const Match found = std::visit([&](const auto& seen) { return match(seen, at); }, observation);
  if (found.fix)
    append(*found.fix);
  else if (!events_.empty() && events_.back().extrapolated)
    events_.pop_back();
  for (const Event& event : later) append(event.input, event.extrapolated);
  watch_innovations(found.result, shot.look, first_of_look);
  return found.result;
}

EkfLocalizer::Match EkfLocalizer::match(const EllipseObservation& observation,
                                        const EkfState& at) const {
  const AssociationModel model{map_, plan_ ? &*plan_ : nullptr, on_ground_, params_.sensor, gate_};
  const Eigen::Vector3d z = measured_disc(observation);
  const Eigen::Matrix3d R = measurement_covariance(observation);
  const Association found = associate(model, at, observation, z, R);
  if (!found.any_image) return {{UpdateStatus::degenerate, std::nullopt, 0.0, 0}, std::nullopt};
  if (found.inside_gate.empty())
    return {{UpdateStatus::gated, std::nullopt, found.best_nis, kDof}, std::nullopt};
  const Candidate& best = found.inside_gate.front();
  if (found.inside_gate.size() > 1 &&
      found.inside_gate[1].cost - best.cost < 2.0 * std::log(params_.ambiguity_ratio))
    return {{UpdateStatus::ambiguous, std::nullopt, best.nis, kDof}, std::nullopt};
  return {{UpdateStatus::fused, best.landmark->id, best.nis, kDof},
          DiscFix{observation.shot, *best.landmark, z, params_.use_size ? R : without_size(R)}};
}

EkfLocalizer::Match EkfLocalizer::match(const PointsObservation& observation,
                                        const EkfState& at) const {
  const Landmark* landmark = map_.find(observation.landmark);
  if (landmark == nullptr) return {{UpdateStatus::gated, std::nullopt, 0.0, 0}, std::nullopt};
  PointsFix fix{observation.shot, *landmark,
                seen_points(*landmark, observation, params_.centre_floor_px)};
  if (fix.points.empty()) return {{UpdateStatus::degenerate, std::nullopt, 0.0, 0}, std::nullopt};
  const UpdateResult result =
      gate_points({on_ground_, params_.sensor, params_.gate_probability}, at, fix);
  if (result.status != UpdateStatus::fused) return {result, std::nullopt};
  return {result, std::move(fix)};
}

void EkfLocalizer::append(const EkfInput& input, bool extrapolated) {
  Event event{input, extrapolated, state(), events_.empty() ? Window{} : events_.back().window};
  if (const auto* motion = std::get_if<Motion>(&input))
    move_by(*motion, event);
  else
    fuse(*shot_of(input), event);
  assert(event.after.mean.allFinite() && event.after.covariance.allFinite());
  events_.push_back(std::move(event));
}

void EkfLocalizer::move_by(const Motion& motion, Event& event) const {
  event.after = propagate(event.after, motion, params_.odometry);
  Window& window = event.window;
  if (window.events > 0) ++window.events;
  if ((motion.increment.to - window.last_image).seconds() > kLookPause) window = {};
}

void EkfLocalizer::fuse(const Shot& shot, Event& event) const {
  Window& window = event.window;
  event.after = with_look(event.after, shot.look);
  if (window.events == 0 || window.start.look != shot.look) {
    window = {};
    window.start = event.after;
  }
  ++window.events;
  ++window.images;
  window.last_image = shot.stamp;
  auto smoothed = smooth_look(window.start, inputs_of_look(event), guess_of_look(event),
                              {on_ground_, params_.sensor, params_.odometry}, params_.iterations,
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
    window.images = 1 + static_cast<int>(std::count_if(
                            events_.end() - static_cast<std::ptrdiff_t>(window.events - 1),
                            events_.end(), [](const Event& e) { return is_image(e.input); }));
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
    const bool left_out = is_image(it->input) && image++ % stride != 0;
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
  if (auto* motion = std::get_if<Motion>(&later.front().input)) {
    const Motion whole = *motion;
    if (whole.increment.from < stamp) {
      const double f = fraction_at(whole.increment, stamp);
      Motion before = first_part(whole, f);
      before.increment.to = stamp;
      append(before, later.front().extrapolated);
      *motion = second_part(whole, f);
      motion->increment.from = stamp;
    }
  }
  return later;
}

void EkfLocalizer::extrapolate(Stamp stamp) {
  Motion motion;
  motion.increment = motion.even = {state().stamp, stamp, 0.0, 0.0, 0.0};
  const auto last = std::find_if(events_.rbegin(), events_.rend(), [](const Event& event) {
    return std::holds_alternative<Motion>(event.input);
  });
  if (last != events_.rend()) {
    const auto& before = std::get<Motion>(last->input);
    const OdometryIncrement& u = before.increment;
    if (u.from < u.to)
      motion = first_part(before, (stamp - state().stamp).seconds() / (u.to - u.from).seconds());
    motion.increment.from = state().stamp;
    motion.increment.to = stamp;
  }
  append(motion, true);
}

std::vector<EkfInput> EkfLocalizer::drop_extrapolated() {
  const auto first = std::find_if(events_.begin(), events_.end(),
                                  [](const Event& event) { return event.extrapolated; });
  std::vector<EkfInput> fixes;
  for (auto it = first; it != events_.end(); ++it)
    if (is_image(it->input)) fixes.push_back(it->input);
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
    if (first_of_look) first_of_looks_.push_back(result);
    if (first_of_looks_.size() > static_cast<std::size_t>(params_.nis_looks))
      first_of_looks_.pop_front();
  }
  const bool rejected = rejections_ >= params_.lost_rejections &&
                        rejected_looks_.size() >= static_cast<std::size_t>(params_.lost_looks);
  said_lost_ = said_lost_ || rejected || innovations_are_unlikely();
}

bool EkfLocalizer::innovations_are_unlikely() const {
  double sum = 0.0;
  // Looks to come count as discs.
  int dof = kDof * (params_.nis_looks - static_cast<int>(first_of_looks_.size()));
  for (const UpdateResult& first : first_of_looks_) {
    sum += first.nis;
    dof += first.dof;
  }
  return sum > nis_limits_[static_cast<std::size_t>(dof)];
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
