#include "loop.hpp"

#include "localizer_params.hpp"

#include <algorithm>
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

/// How far from the principal point the feature lies, px.
double off_centre(const Observation& observation) {
  const Intrinsics& camera = pinhole(shot_of(observation));
  return (image_extent(observation).centre - Eigen::Vector2d(camera.u0, camera.v0)).norm();
}

}  // namespace

Loop::Loop(const MissionSetup& setup, std::uint64_t seed, const std::vector<Listener*>& listeners)
    : setup_(setup),
      seed_(seed),
      rig_(setup.robot.rig()),
      listeners_(listeners),
      simulator_(setup.robot, setup.world, setup.appearance, draw_start(setup, seed), seed,
                 setup.disturbances),
      information_(landmark_information(setup)),
      relocalizer_(setup.world.landmarks, setup.world.plan, setup.on_ground(),
                   relocalizer_params(setup)),
      scheduler_(setup, information_, seed),
      watcher_(setup.tracker, setup.world.landmarks, setup.on_ground(), setup.ekf.sensor),
      gaze_(setup.robot.robot.head, setup.robot.robot.head_limits, setup.robot.zoom, setup.gaze,
            setup.world.ground),
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
    localizers_.back()->reset(now_, setup.prior);
  }
  localizer_ticks_.resize(localizers_.size());
}

Outcome Loop::run() {
  for (Listener* listener : listeners_) listener->on_start(setup_, seed_);
  tell("plan", {{"length_m", setup_.path.length()}}, {{"policy", setup_.look.policy}});
  std::optional<Outcome> end;
  while (!(end = outcome())) tick();
  Texts texts;
  if (*end == Outcome::collided)
    texts.emplace_back("with", simulator_.clearance_of_people() < 0.0 ? "person" : "building");
  const Pose2& pose = simulator_.robot().truth().pose;
  tell(std::string(to_string(*end)), {{"x_m", pose.x}, {"y_m", pose.y}}, texts);
  for (Listener* listener : listeners_) listener->on_finish(*end, now_);
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
  if (now_.seconds() >= setup_.timeout_s) return Outcome::timeout;
  return std::nullopt;
}

void Loop::tick() {
  const Stopwatch step;
  timing_ = {};
  if (simulator_.kidnap()) {
    const Pose2& pose = simulator_.robot().truth().pose;
    tell("kidnapped", {{"x_m", pose.x}, {"y_m", pose.y}, {"theta_rad", pose.theta}});
  }
  const Pose2 before = simulator_.robot().truth().pose;
  simulator_.advance(dt_);
  now_ = now_ + dt_;
  predict();

  late_frames_.expose({simulator_.expose(), shot_, simulator_.robot().truth()});
  delivered_ = late_frames_.take(now_);
  const ExposedFrame& shown = delivered_ ? *delivered_ : *late_frames_.newest();
  const TimedFrame frame(*shown.frame);
  sighting_.reset();
  observation_.reset();
  activations_.reset();
  for (auto& localizer_tick : localizer_ticks_) localizer_tick.update.reset();
  if (setup_.full_frames) imaging::grey_image(frame);
  // A frame of an earlier look says nothing of this one.
  const bool usable = delivered_ && delivered_->shot.look == look_;
  if (recovering_) {
    recover(usable ? &frame : nullptr);
  } else {
    if (usable) watch(frame);
    if (observation_) localize(*observation_);
    plan();
    steer();
  }

  for (std::size_t i = 0; i < localizers_.size(); ++i)
    localizer_ticks_[i].belief = &localizers_[i]->belief();
  timing_.render = frame.render_ms();
  timing_.track -= std::min(timing_.track, timing_.render);
  timing_.step = step.elapsed_ms();

  std::optional<double> centring;
  if (observation_ && acquired_) centring = off_centre(*observation_);
  const Tick told{now_,
                  simulator_.robot().truth(),
                  shown.truth,
                  before,
                  odometry_,
                  head_,
                  command_,
                  recovering_ ? GazeState::search : gaze_.state(),
                  gaze_.current(),
                  observation_ ? shot_of(*observation_).look : look_,
                  sighting_ ? std::optional(sighting_->status) : std::nullopt,
                  observation_ ? &*observation_ : nullptr,
                  centring,
                  acquired_ ? (now_ - *acquired_).seconds() : 0.0,
                  stopped_to_look_,
                  localizer_ticks_,
                  primary_,
                  pilot_.station(),
                  *shown.frame,
                  sighting_ ? sighting_->predicted : std::nullopt,
                  timing_,
                  activations_};
  for (Listener* listener : listeners_) listener->on_tick(told);
}

void Loop::predict() {
  odometry_ = simulator_.robot().read_odometry();
  head_ = simulator_.robot().read_head();
  const Camera& camera = rig_.cameras.front();
  shot_ = {now_, camera.id, camera.model(head_.zoom_mm), head_.angles, head_.zoom_mm, look_};
  travelled_m_ += std::abs(odometry_.trans);
  motion_.moved(odometry_);
  const Stopwatch watch;
  for (const auto& localizer : localizers_) localizer->predict(odometry_);
  timing_.localize += watch.elapsed_ms();
}

void Loop::watch(const imaging::Frame& frame) {
  const auto& order = gaze_.current();
  if (request_ == servo::TrackRequest::none || !order) return;
  const Landmark* landmark = setup_.world.landmarks.find(order->landmark);
  const Stopwatch watch;
  const Shot& shot = delivered_->shot;
  sighting_ =
      watcher_.watch(frame, request_, shot, motion_.belief_at(shot.stamp, belief()), *landmark);
  timing_.track += watch.elapsed_ms();
  observation_ = sighting_->observation;
}

void Loop::localize(const Observation& observation) {
  const Stopwatch watch;
  for (std::size_t i = 0; i < localizers_.size(); ++i)
    localizer_ticks_[i].update = localizers_[i]->update(observation);
  timing_.localize += watch.elapsed_ms();

  const auto& result = *localizer_ticks_[primary_].update;
  if (result.status == localization::UpdateStatus::fused) {
    rejected_in_a_row_ = 0;
    if (!look_fused_) scheduler_.fused(travelled_m_, gaze_.current()->landmark);
    look_fused_ = true;
    failed_.clear();
    return;
  }
  if (result.status == localization::UpdateStatus::unsupported) return;
  if (rejected_in_a_row_++ == 0)
    tell("rejected",
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
      scheduler_.demand(now_, belief(), travelled_m_, pilot_.path().length() - pilot_.station());
  // A landmark that is not where the belief has it is reason enough to stand still.
  const bool uneasy = demand == planner::LookDemand::stopped || !failed_.empty();
  const bool idle = gaze_.state() == GazeState::idle;
  LookScheduler::Going going{pilot_.station(), odometry_.trans / dt_.seconds(), uneasy};
  std::optional<LookScheduler::Decision> decision;
  if (idle && (uneasy || demand != planner::LookDemand::none))
    decision = scheduler_.choose(now_, belief(), head_, going);
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
  gaze_.rest_at(waits ? scheduler_.prepare(now_, belief(), head_, going) : std::nullopt);
  timing_.plan += watch.elapsed_ms();
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
  tell("look", numbers, {{"reason", decision.reason}});
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
  if (over && !over_limit_1_) tell("limit_1", {{"sigma_m", sigma}});
  over_limit_1_ = over;
  if (stop == stopped_to_look_) return;
  const bool limit_2 = demand == planner::LookDemand::stopped;
  const Texts why{{"reason", limit_2 ? "the uncertainty is above the second limit"
                                     : "a landmark was not where it should be"}};
  tell(stop ? "stop" : "restart", {{"sigma_m", sigma}}, stop ? why : Texts{});
}

void Loop::drop_look(const std::string& reason) {
  const auto order = gaze_.current();
  rejected_in_a_row_ = 0;
  if (!order) return;
  note_failure(order->landmark);
  tell("dropped",
       {{"look", static_cast<double>(look_)}, {"landmark", static_cast<double>(order->landmark)}},
       {{"reason", reason}});
  gaze_.cancel();
  request_ = servo::TrackRequest::none;
  acquired_.reset();
}

void Loop::steer() {
  if (recovering_) {
    command_ = {};
    simulator_.robot().command(command_, look_around_.step(head_));
    return;
  }
  command_ = drive();
  const BaseRates odometry{odometry_.trans / dt_.seconds(),
                           (odometry_.rot1 + odometry_.rot2) / dt_.seconds()};
  const BaseRates expected = base_motion_.expect(odometry, command_);
  const Stopwatch watch;
  const auto order = gaze_.current();
  servo::GazeInput input{now_,           head_,       expected, belief(), setup_.world.landmarks,
                         pinhole(shot_), std::nullopt};
  input.sighting = sighting_now();
  const servo::GazeOutput output = gaze_.step(input);
  timing_.servo += watch.elapsed_ms();
  if (order) {
    const Landmark* landmark = setup_.world.landmarks.find(order->landmark);
    if (delivered_)
      watcher_.settle(delivered_->shot, motion_.belief_at(delivered_->shot.stamp, belief()),
                      *landmark);
    if (output.event != servo::GazeEvent::none) tell_gaze(output.event, order->landmark);
  }
  request_ = output.request;
  simulator_.robot().command(command_, output.command);
}

/// The feature where the belief's motion since its exposure has carried it.
std::optional<servo::GazeSighting> Loop::sighting_now() const {
  // A look that was dropped in this tick, and perhaps followed by another, has no sighting.
  if (!observation_ || !gaze_.current()) return std::nullopt;
  const Shot& then = shot_of(*observation_);
  if (then.look != look_) return std::nullopt;
  const Landmark* landmark = setup_.world.landmarks.find(gaze_.current()->landmark);
  const ImageExtent extent = image_extent(*observation_, landmark);
  const servo::GazeSighting sighting{extent.centre, extent.radius_px};
  if (then.stamp == now_) return sighting;
  const auto moved =
      watcher_.motion(then, motion_.belief_at(then.stamp, belief()), shot_, belief(), *landmark);
  if (!moved) return sighting;
  return servo::GazeSighting{sighting.uv + moved->shift, sighting.radius_px * moved->growth};
}

void Loop::note_failure(LandmarkId landmark) {
  scheduler_.failed(now_, landmark);
  if (!look_fused_) failed_.push_back(landmark);
}

void Loop::tell_gaze(servo::GazeEvent event, LandmarkId landmark) {
  if (event == servo::GazeEvent::acquired)
    acquired_ = now_;
  else
    acquired_.reset();
  if (event == servo::GazeEvent::expired) note_failure(landmark);
  // "lost" alone is said of the belief.
  tell(event == servo::GazeEvent::lost ? "target_lost" : std::string(to_string(event)),
       {{"look", static_cast<double>(look_)}, {"landmark", static_cast<double>(landmark)}});
}

void Loop::tell(const std::string& kind, const Numbers& numbers, const Texts& texts) const {
  const Event event{now_, kind, numbers, texts};
  for (Listener* listener : listeners_) listener->on_event(event);
}

}  // namespace vigia::mission
