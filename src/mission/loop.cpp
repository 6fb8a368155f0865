#include "loop.hpp"

#include "localizer_params.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vigia::mission {
namespace {

/// The true start: drawn round the mission's start with the deviation that the prior states.
Pose2 draw_start(const MissionSetup& setup, std::uint64_t seed) {
  RandomStream stream(seed, "start");
  const double dx = setup.start_sigma_m * stream.normal();
  const double dy = setup.start_sigma_m * stream.normal();
  const double dtheta = setup.start_sigma_rad * stream.normal();
  return {setup.start.x + dx, setup.start.y + dy, wrap_angle(setup.start.theta + dtheta)};
}

EventKind event_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::arrived:
      return EventKind::arrived;
    case Outcome::collided:
      return EventKind::collided;
    case Outcome::timeout:
      return EventKind::timeout;
    case Outcome::stuck:
      return EventKind::stuck;
  }
  return EventKind::stuck;
}

EventKind event_of(servo::GazeEvent event) {
  switch (event) {
    case servo::GazeEvent::none:
      break;
    case servo::GazeEvent::acquired:
      return EventKind::acquired;
    case servo::GazeEvent::released:
      return EventKind::released;
    case servo::GazeEvent::lost:
      return EventKind::target_lost;
    case servo::GazeEvent::expired:
      return EventKind::expired;
  }
  assert(false && "nothing happened");
  return EventKind::expired;
}

/// How far from the principal point the feature lies, px.
double off_centre(const Observation& observation) {
  const Intrinsics& camera = sensor_of(observation).intrinsics;
  return (image_extent(observation).centre - Eigen::Vector2d(camera.u0, camera.v0)).norm();
}

}  // namespace

Loop::Loop(const MissionSetup& setup, std::uint64_t seed, const std::vector<Listener*>& listeners)
    : setup_(setup),
      seed_(seed),
      listeners_(listeners),
      simulator_(setup.robot, setup.world, setup.appearance, draw_start(setup, seed), seed,
                 setup.disturbances),
      information_(landmark_information(setup)),
      relocalizer_(setup.world.landmarks, setup.world.plan, setup.robot.robot.head,
                   relocalizer_params(setup)),
      scheduler_(setup, information_, seed),
      watcher_(setup.tracker, setup.world.landmarks, setup.robot.robot.head, setup.ekf.sensor),
      gaze_(setup.robot.robot.head, setup.robot.robot.head_limits, setup.robot.zoom, setup.gaze),
      base_motion_({setup.robot.robot.base, setup.tick_s}),
      pilot_(setup.path, setup.world.plan, setup.robot.robot.radius_m, setup.robot.robot.base,
             setup.pilot),
      look_around_(setup),
      waypoints_(setup.waypoints),
      late_frames_(simulator_.latency()),
      motion_(Duration::from_seconds(simulator_.latency().seconds() + setup.tick_s)),
      dt_(Duration::from_seconds(setup.tick_s)) {
  for (const auto& name : setup.localizers) {
    if (name == setup.primary) primary_ = localizers_.size();
    localizers_.push_back(make_localizer(name, setup));
    localizers_.back()->reset(now(), setup.prior);
  }
  tick_.estimator.localizers.resize(localizers_.size());
  tick_.estimator.primary = primary_;
  tick_.estimator.truth.emplace();
}

Outcome Loop::run() {
  for (Listener* listener : listeners_) listener->on_start(setup_, seed_);
  tell(EventKind::plan, {{"length_m", setup_.path.length()}}, {{"policy", setup_.look.policy}});
  std::optional<Outcome> end;
  while (!(end = outcome())) tick();
  Texts texts;
  if (*end == Outcome::collided)
    texts.emplace_back("with", simulator_.clearance_of_people() < 0.0 ? "person" : "building");
  const Pose2& pose = simulator_.robot().truth().pose;
  tell(event_of(*end), {{"x_m", pose.x}, {"y_m", pose.y}}, texts);
  for (Listener* listener : listeners_) listener->on_finish(*end, now());
  return *end;
}

std::optional<Outcome> Loop::outcome() const {
  if (simulator_.clearance() < 0.0) return Outcome::collided;
  if (gave_up_) return gave_up_;
  if (pilot_.arrived()) {
    const Eigen::Vector2d goal = setup_.path.points().back();
    const Eigen::Vector2d off = simulator_.robot().truth().pose.position() - goal;
    return off.norm() <= setup_.goal_tolerance_m ? Outcome::arrived : Outcome::stuck;
  }
  if (now().seconds() >= setup_.timeout_s) return Outcome::timeout;
  return std::nullopt;
}

void Loop::begin_tick() {
  EstimatorTick& estimator = tick_.estimator;
  estimator.now = estimator.now + dt_;
  estimator.observations.clear();
  estimator.truth->exposures.clear();
  for (auto& localizer : estimator.localizers) localizer.updates.clear();
  sighting_.reset();
  tick_.activations.reset();
  tick_.timing = {};
}

void Loop::tick() {
  const Stopwatch step;
  if (simulator_.kidnap()) {
    const Pose2& pose = simulator_.robot().truth().pose;
    tell(EventKind::kidnapped, {{"x_m", pose.x}, {"y_m", pose.y}, {"theta_rad", pose.theta}});
  }
  begin_tick();
  tick_.estimator.truth->pose_before = simulator_.robot().truth().pose;
  simulator_.advance(dt_);
  predict();

  late_frames_.expose({simulator_.expose(), sensor_, simulator_.robot().truth()});
  delivered_ = late_frames_.take(now());
  const ExposedFrame& shown = delivered_ ? *delivered_ : *late_frames_.newest();
  const TimedFrame frame(*shown.frame);
  if (setup_.full_frames) imaging::grey_image(frame);
  // A frame of an earlier look says nothing of this one.
  const bool usable = delivered_ && delivered_->sensor.look == look_;
  if (recovering_) {
    recover(usable ? &frame : nullptr);
  } else {
    if (usable) watch(frame);
    if (observation() != nullptr) localize(*observation());
    plan();
    steer();
  }
  tick_.timing.render = frame.render_ms();
  tick_.timing.track -= std::min(tick_.timing.track, tick_.timing.render);
  tick_.timing.step = step.elapsed_ms();
  end_tick(shown);
}

void Loop::end_tick(const ExposedFrame& shown) {
  EstimatorTick& estimator = tick_.estimator;
  for (std::size_t i = 0; i < localizers_.size(); ++i)
    estimator.localizers[i].belief = &localizers_[i]->belief();
  tick_.truth = simulator_.robot().truth();
  estimator.truth->pose = tick_.truth.pose;
  const Observation* seen = observation();
  if (seen != nullptr) {
    const HeadAngles& angle = shown.truth.look_angle_error;
    estimator.truth->exposures.push_back(
        {shown.truth.stamp,
         shown.truth.pose,
         {angle.pan, angle.tilt, shown.truth.look_log_focal_error}});
  }
  AttentionTick& attention = tick_.attention;
  attention.gaze = recovering_ ? GazeState::search : gaze_.state();
  attention.order = gaze_.current();
  attention.look = seen != nullptr ? sensor_of(*seen).look : look_;
  attention.feature = sighting_ ? std::optional(sighting_->status) : std::nullopt;
  attention.predicted = sighting_ ? sighting_->predicted : std::nullopt;
  attention.centring_px.reset();
  if (seen != nullptr && acquired_) attention.centring_px = off_centre(*seen);
  attention.tracked_s = acquired_ ? (now() - *acquired_).seconds() : 0.0;
  attention.stopped_to_look = stopped_to_look_;
  tick_.station_m = pilot_.station();
  tick_.frame = shown.frame.get();
  for (Listener* listener : listeners_) listener->on_tick(tick_);
}

const Observation* Loop::observation() const {
  const auto& observations = tick_.estimator.observations;
  return observations.empty() ? nullptr : &observations.front();
}

void Loop::predict() {
  tick_.estimator.odometry = simulator_.robot().read_odometry();
  tick_.head = simulator_.robot().read_head();
  sensor_ = {now(), setup_.robot.zoom.at(tick_.head.zoom_mm), tick_.head.angles, tick_.head.zoom_mm,
             look_};
  travelled_m_ += std::abs(tick_.estimator.odometry.trans);
  motion_.moved(tick_.estimator.odometry);
  const Stopwatch watch;
  for (const auto& localizer : localizers_) localizer->predict(tick_.estimator.odometry);
  tick_.timing.localize += watch.elapsed_ms();
}

void Loop::watch(const imaging::Frame& frame) {
  const auto& order = gaze_.current();
  if (request_ == servo::TrackRequest::none || !order) return;
  const Landmark* landmark = setup_.world.landmarks.find(order->landmark);
  const Stopwatch watch;
  const SensorSnapshot& sensor = delivered_->sensor;
  sighting_ =
      watcher_.watch(frame, request_, sensor, motion_.belief_at(sensor.stamp, belief()), *landmark);
  tick_.timing.track += watch.elapsed_ms();
  if (sighting_->observation) tick_.estimator.observations.push_back(*sighting_->observation);
}

void Loop::localize(const Observation& observation) {
  const Stopwatch watch;
  for (std::size_t i = 0; i < localizers_.size(); ++i)
    tick_.estimator.localizers[i].updates.push_back(localizers_[i]->update(observation));
  tick_.timing.localize += watch.elapsed_ms();

  const auto& result = tick_.estimator.localizers[primary_].updates.back();
  if (result.status == localization::UpdateStatus::fused) {
    rejected_in_a_row_ = 0;
    if (!look_fused_) scheduler_.fused(travelled_m_, gaze_.current()->landmark);
    look_fused_ = true;
    failed_.clear();
    return;
  }
  if (result.status == localization::UpdateStatus::unsupported) return;
  if (rejected_in_a_row_++ == 0)
    tell(EventKind::rejected,
         {{"look", static_cast<double>(look_)},
          {"landmark", static_cast<double>(gaze_.current()->landmark)},
          {"nis", result.nis}},
         {{"reason", std::string(to_string(result.status))}});
}

void Loop::plan() {
  const Stopwatch watch;
  if (rejected_in_a_row_ >= setup_.look.rejections_to_drop)
    drop_look("the filter rejects what is tracked");
  if (nothing_is_where_it_should_be()) localizers_[primary_]->lose();
  if (belief().status == BeliefStatus::lost) {
    begin_recovery();
    return;
  }
  const auto demand =
      scheduler_.demand(now(), belief(), travelled_m_, pilot_.path().length() - pilot_.station());
  // A landmark that is not where the belief has it is reason enough to stand still.
  const bool uneasy = demand == planner::LookDemand::stopped || !failed_.empty();
  const bool idle = gaze_.state() == GazeState::idle;
  LookScheduler::Going going{pilot_.station(), tick_.estimator.odometry.trans / dt_.seconds(),
                             uneasy};
  std::optional<LookScheduler::Decision> decision;
  if (idle && (uneasy || demand != planner::LookDemand::none))
    decision = scheduler_.choose(now(), belief(), tick_.head, going);
  // Two landmarks were not where they should be, and there is no third to ask.
  if (idle && !decision && different_failed() > 1) {
    localizers_[primary_]->lose();
    begin_recovery();
    return;
  }
  // Where there is nothing to look at, standing helps nobody.
  const bool stop = uneasy && (!idle || decision);
  tell_limits(demand, stop);
  stopped_to_look_ = stop;
  going.standing = stop;
  if (decision) begin_look(*decision);
  const bool waits = gaze_.state() == GazeState::idle;
  gaze_.rest_at(waits ? scheduler_.prepare(now(), belief(), tick_.head, going) : std::nullopt);
  tick_.timing.plan += watch.elapsed_ms();
}

void Loop::begin_look(const LookScheduler::Decision& decision) {
  const GazeOrder& order = decision.order;
  look_ = order.look;
  look_fused_ = false;
  rejected_in_a_row_ = 0;
  simulator_.robot().begin_look();
  gaze_.order(order);
  Numbers numbers{{"look", static_cast<double>(look_)},
                  {"landmark", static_cast<double>(order.landmark)},
                  {"sigma_m", belief().position_sigma()},
                  {"travelled_m", travelled_m_}};
  if (decision.suitability) numbers.emplace_back("suitability", *decision.suitability);
  if (order.zoom_mm) numbers.emplace_back("zoom_mm", *order.zoom_mm);
  tell(EventKind::look, numbers, {{"reason", decision.reason}});
}

std::size_t Loop::different_failed() const {
  return std::set<LandmarkId>(failed_.begin(), failed_.end()).size();
}

bool Loop::nothing_is_where_it_should_be() const {
  const auto enough = static_cast<std::size_t>(setup_.look.failures_to_lose);
  if (failed_.size() < enough) return false;
  return different_failed() > 1 || failed_.size() >= 2 * enough;
}

void Loop::tell_limits(planner::LookDemand demand, bool stop) {
  const bool over = setup_.look.trigger.kind == planner::LookTriggerParams::Kind::uncertainty &&
                    demand != planner::LookDemand::none;
  const double sigma = belief().position_sigma();
  if (over && !over_limit_1_) tell(EventKind::limit_1, {{"sigma_m", sigma}});
  over_limit_1_ = over;
  if (stop == stopped_to_look_) return;
  const bool limit_2 = demand == planner::LookDemand::stopped;
  const Texts why{{"reason", limit_2 ? "the uncertainty is above the second limit"
                                     : "a landmark was not where it should be"}};
  tell(stop ? EventKind::stop : EventKind::restart, {{"sigma_m", sigma}}, stop ? why : Texts{});
}

void Loop::drop_look(const std::string& reason) {
  const auto order = gaze_.current();
  rejected_in_a_row_ = 0;
  if (!order) return;
  note_failure(order->landmark);
  tell(EventKind::dropped,
       {{"look", static_cast<double>(look_)}, {"landmark", static_cast<double>(order->landmark)}},
       {{"reason", reason}});
  gaze_.cancel();
  request_ = servo::TrackRequest::none;
  acquired_.reset();
}

void Loop::steer() {
  if (recovering_) {
    tick_.base_command = {};
    simulator_.robot().command(tick_.base_command, look_around_.step(tick_.head));
    return;
  }
  tick_.base_command = drive();
  const BaseRates odometry{
      tick_.estimator.odometry.trans / dt_.seconds(),
      (tick_.estimator.odometry.rot1 + tick_.estimator.odometry.rot2) / dt_.seconds()};
  const BaseRates expected = base_motion_.expect(odometry, tick_.base_command);
  const Stopwatch watch;
  const auto order = gaze_.current();
  servo::GazeInput input{
      now(),       tick_.head, expected, belief(), setup_.world.landmarks, sensor_.intrinsics,
      std::nullopt};
  input.sighting = sighting_now();
  const servo::GazeOutput output = gaze_.step(input);
  tick_.timing.servo += watch.elapsed_ms();
  if (order) {
    const Landmark* landmark = setup_.world.landmarks.find(order->landmark);
    if (delivered_)
      watcher_.settle(delivered_->sensor, motion_.belief_at(delivered_->sensor.stamp, belief()),
                      *landmark);
    if (output.event != servo::GazeEvent::none) tell_gaze(output.event, order->landmark);
  }
  request_ = output.request;
  simulator_.robot().command(tick_.base_command, output.command);
}

/// The feature where the belief's motion since its exposure has carried it.
std::optional<servo::GazeSighting> Loop::sighting_now() const {
  // A look that was dropped in this tick, and perhaps followed by another, has no sighting.
  if (observation() == nullptr || !gaze_.current()) return std::nullopt;
  const SensorSnapshot& then = sensor_of(*observation());
  if (then.look != look_) return std::nullopt;
  const Landmark* landmark = setup_.world.landmarks.find(gaze_.current()->landmark);
  const ImageExtent extent = image_extent(*observation(), landmark);
  const servo::GazeSighting sighting{extent.centre, extent.radius_px};
  if (then.stamp == now()) return sighting;
  const auto moved =
      watcher_.motion(then, motion_.belief_at(then.stamp, belief()), sensor_, belief(), *landmark);
  if (!moved) return sighting;
  return servo::GazeSighting{sighting.uv + moved->shift, sighting.radius_px * moved->growth};
}

void Loop::note_failure(LandmarkId landmark) {
  scheduler_.failed(now(), landmark);
  if (!look_fused_) failed_.push_back(landmark);
}

void Loop::tell_gaze(servo::GazeEvent event, LandmarkId landmark) {
  if (event == servo::GazeEvent::acquired)
    acquired_ = now();
  else
    acquired_.reset();
  if (event == servo::GazeEvent::expired) note_failure(landmark);
  tell(event_of(event),
       {{"look", static_cast<double>(look_)}, {"landmark", static_cast<double>(landmark)}});
}

void Loop::tell(EventKind kind, const Numbers& numbers, const Texts& texts) const {
  const Event event{now(), kind, numbers, texts};
  for (Listener* listener : listeners_) listener->on_event(event);
}

}  // namespace vigia::mission
