#include "vigia/localization/ekf.hpp"

#include "look_smoother.hpp"
#include "lost_probability.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "vigia/core/overloaded.hpp"
#include "vigia/localization/chi_square.hpp"

namespace vigia::localization {
namespace {

constexpr int kTypicalDof = 3;  // of an image: a disc's
constexpr int kMaxDof = 5;      // of an image: what points say of the state
/// A look without an image for so long (s) is not linearised anew any more.
constexpr double kLookPause = 1.0;
/// Of a look of more events the older half is not linearised anew any more.
constexpr std::size_t kLookEvents = 250;

MeasurementParams measurement_params(const EkfParams& params) {
  return {params.sensor,          params.gate_probability, params.ambiguity_ratio,
          params.centre_floor_px, params.size_floor,       params.use_size};
}

double fraction_at(const OdometryIncrement& u, Stamp stamp) {
  return (stamp - u.from).seconds() / (u.to - u.from).seconds();
}

/// The shot of an image; nullptr for an increment.
const Shot* shot_of(const LookInput& input) {
  return std::visit(Overloaded{[](const Motion&) -> const Shot* { return nullptr; },
                               [](const auto& match) { return &match.shot; }},
                    input);
}

bool is_image(const LookInput& input) {
  return !std::holds_alternative<Motion>(input);
}

}  // namespace

EkfLocalizer::EkfLocalizer(LandmarkMap map, const RigOnGround& on_ground, const EkfParams& params,
                           std::optional<FloorPlan> plan)
    : params_(params),
      model_(std::move(map), on_ground, measurement_params(params), std::move(plan)),
      nis_limits_(static_cast<std::size_t>(kMaxDof * params.nis_looks) + 1),
      mean_speed_(params.odometry) {
  for (std::size_t dof = 1; dof < nis_limits_.size(); ++dof)
    nis_limits_[dof] = chi_square_quantile(1.0 - params.nis_probability, static_cast<double>(dof));
  reset(Stamp{}, std::nullopt);
}

void EkfLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  base_ = initial_state(stamp, prior.value_or(anywhere()), params_.sensor);
  has_prior_ = prior.has_value();
  events_.clear();
  mean_speed_.reset();
  horizon_ = stamp;
  rejections_ = 0;
  rejected_spans_.clear();
  first_of_looks_.clear();
  innovation_evidence_ = 0.0;
  said_lost_ = false;
  refresh_belief();
}

void EkfLocalizer::lose() {
  said_lost_ = true;
  refresh_belief();
}

void EkfLocalizer::predict(const OdometryIncrement& increment) {
  assert(std::isfinite(increment.rot1 + increment.trans + increment.rot2));
  const std::vector<LookInput> ahead = drop_extrapolated();
  append(Motion{increment, mean_speed_.at_mean_speed(increment)});
  for (const LookInput& fix : ahead) {
    const std::vector<Event> later = roll_back(shot_of(fix)->stamp);
    append(fix);
    for (const Event& event : later) append(event.input, event.extrapolated);
  }
  forget_old();
  refresh_belief();
}

UpdateResult EkfLocalizer::update(const Observation& observation) {
  const auto image = landmark_image(observation);
  UpdateResult result{UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  if (!image)
    result.status = UpdateStatus::unsupported;
  else if (!has_prior_)
    result.status = UpdateStatus::no_prior;
  else if (std::visit([](const auto* seen) { return is_usable(*seen); }, *image))
    result = process(observation);
  ++counts_[static_cast<std::size_t>(result.status)];
  refresh_belief();
  return result;
}

UpdateResult EkfLocalizer::process(const Observation& observation) {
  const Shot& shot = vigia::shot_of(observation);
  if (shot.stamp < horizon_) return {UpdateStatus::too_late, std::nullopt, 0.0, 0};
  const std::vector<Event> later = roll_back(shot.stamp);
  const bool first_of_look = begins_look(shot);
  const LookState at = with_look(state(), shot);
  Association found = model_.associate(observation, at);
  if (found.match)
    append(std::visit([](auto& match) { return LookInput(std::move(match)); }, *found.match));
  else if (!events_.empty() && events_.back().extrapolated)
    events_.pop_back();
  for (const Event& event : later) append(event.input, event.extrapolated);
  monitor_innovations(found.result, span_of(shot, model_.on_ground().rig), first_of_look);
  return found.result;
}

void EkfLocalizer::append(const LookInput& input, bool extrapolated) {
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
  event.after = with_look(event.after, shot);
  const bool directed = on_head(model_.on_ground().rig.at(shot.camera));
  if (window.events == 0 || (directed && window.start.look != shot.look)) {
    window = {};
    window.start = event.after;
  }
  window.fixed_camera = window.fixed_camera || !directed;
  ++window.events;
  ++window.images;
  window.last_image = shot.stamp;
  auto smoothed = smooth_look(window.start, inputs_of_look(event), guess_of_look(event),
                              {model_, params_.odometry}, params_.iterations, params_.converged);
  if (!smoothed) {
    window = {};
    return;
  }
  event.after = smoothed->filtered.back();
  window.trajectory = std::move(smoothed->trajectory);
  // A fixed camera looks for ever: of its images none is left out, the older ones stay as they are.
  const bool full = window.fixed_camera && window.images >= params_.look_images;
  if (window.events > kLookEvents || (full && window.events > 1)) {
    const auto half = static_cast<std::ptrdiff_t>(window.events / 2);
    window.start = smoothed->filtered[static_cast<std::size_t>(half) - 1];
    window.trajectory.erase(window.trajectory.begin(), window.trajectory.begin() + half);
    window.events = window.trajectory.size();
    window.images = 1 + static_cast<int>(std::count_if(
                            events_.end() - static_cast<std::ptrdiff_t>(window.events - 1),
                            events_.end(), [](const Event& e) { return is_image(e.input); }));
  }
}

std::vector<const LookInput*> EkfLocalizer::inputs_of_look(const Event& event) const {
  const Window& window = event.window;
  int stride = 1;
  while (window.images > stride * params_.look_images) stride *= 2;
  std::vector<const LookInput*> inputs;
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

LookState EkfLocalizer::with_look(const LookState& state, const Shot& shot) const {
  const bool same = state.look == shot.look || !model_.has_look_biases(shot.camera);
  return same ? state : begin_look(state, shot.look, params_.sensor);
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
  motion.increment = motion.mean_speed = {state().stamp, stamp, 0.0, 0.0, 0.0};
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

std::vector<LookInput> EkfLocalizer::drop_extrapolated() {
  const auto first = std::find_if(events_.begin(), events_.end(),
                                  [](const Event& event) { return event.extrapolated; });
  std::vector<LookInput> fixes;
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

bool EkfLocalizer::begins_look(const Shot& shot) const {
  return state().look != shot.look && on_head(model_.on_ground().rig.at(shot.camera));
}

void EkfLocalizer::monitor_innovations(const UpdateResult& result, const ImageSpan& span,
                                       bool first_of_look) {
  if (result.status == UpdateStatus::gated || result.status == UpdateStatus::degenerate) {
    ++rejections_;
    rejected_spans_.insert(span);
  }
  if (result.status == UpdateStatus::fused) {
    rejections_ = 0;
    rejected_spans_.clear();
    if (first_of_look) first_of_looks_.push_back(result);
    if (first_of_looks_.size() > static_cast<std::size_t>(params_.nis_looks))
      first_of_looks_.pop_front();
  }
  const bool rejected = rejections_ >= params_.lost_rejections &&
                        rejected_spans_.size() >= static_cast<std::size_t>(params_.lost_looks);
  const auto [nis, dof] = innovations_of_looks();
  if (result.status == UpdateStatus::fused && first_of_look)
    innovation_evidence_ = tail_evidence(chi_square_tail(nis, dof), params_.nis_probability);
  said_lost_ = said_lost_ || rejected || nis > nis_limits_[static_cast<std::size_t>(dof)];
}

std::pair<double, int> EkfLocalizer::innovations_of_looks() const {
  double sum = 0.0;
  // Looks to come count as discs.
  int dof = kTypicalDof * (params_.nis_looks - static_cast<int>(first_of_looks_.size()));
  for (const UpdateResult& first : first_of_looks_) {
    sum += first.nis;
    dof += first.dof;
  }
  return {sum, dof};
}

void EkfLocalizer::refresh_belief() {
  const LookState& now = state();
  belief_.stamp = now.stamp;
  belief_.pose = now.pose();
  belief_.covariance = now.pose_covariance();
  const double sigma_m = belief_.position_sigma();
  const bool says_lost = said_lost_ || !has_prior_;
  const bool lost = says_lost || sigma_m > params_.lost_sigma_m;
  belief_.status = lost ? BeliefStatus::lost : BeliefStatus::tracking;
  const double rejected = rejection_probability(rejections_, params_.lost_rejections);
  belief_.lost_probability = says_lost ? kSaidLost
                                       : either(probability_of_half_a_metre(sigma_m),
                                                either(rejected, innovation_evidence_));
}

}  // namespace vigia::localization
