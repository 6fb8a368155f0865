#include "loop.hpp"

#include "robot_parts.hpp"
#include "stopwatch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "vigia/imaging/image_frame.hpp"
#include "vigia/mission/localizers.hpp"

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
    case Outcome::lost:
      return EventKind::still_lost;
  }
  return EventKind::stuck;
}

RingModel ring_model(const MissionSetup& setup) {
  const sim::RangeRingParams ring = setup.robot.range_ring.value_or(sim::RangeRingParams{});
  return {from_deg(setup.pilot.ring.half_angle_deg), setup.pilot.ring.sigma_m,
          setup.pilot.ring.sigma_relative, ring.height_m};
}

/// A camera that does not move has no looks and none of their errors, a lens that does not zoom no
/// error of its focal length that changes with them.
ExposureTruth truth_of(const ExposedFrame& exposure, const Camera& camera) {
  const sim::RobotTruth& truth = exposure.truth;
  ExposureTruth known{truth.stamp, truth.pose, {}};
  if (exposure.shot.look == 0) return known;
  const bool zooms = std::holds_alternative<ZoomCalibration>(camera.optics);
  known.bias = {truth.look_angle_error.pan, truth.look_angle_error.tilt,
                zooms ? truth.look_log_focal_error : 0.0};
  return known;
}

}  // namespace

Loop::Loop(const MissionSetup& setup, std::uint64_t seed, const std::vector<Listener*>& listeners)
    : setup_(setup),
      seed_(seed),
      listeners_(listeners),
      log_(listeners),
      simulator_(setup.robot, setup.world, setup.appearance, draw_start(setup, seed), seed,
                 setup.disturbances),
      rig_(setup.robot.rig()),
      cameras_(make_feeds(setup, rig_, simulator_.latency(), simulator_.processing())),
      attention_(make_attention(setup, rig_, seed, log_)),
      rejections_(log_, rig_),
      ground_monitor_(log_, setup.world.ground),
      recovery_(make_recovery(setup, rig_, cameras_, log_)),
      ring_doubt_(setup.world.plan, ring_model(setup)),
      navigator_(setup, log_),
      motion_(Duration::from_seconds(longest_latency(cameras_).seconds() + setup.tick_s)),
      dt_(Duration::from_seconds(setup.tick_s)) {
  EstimatorTick& estimator = tick_.estimator;
  for (const auto& name : setup.localizers) {
    if (name == setup.primary) estimator.primary = localizers_.size();
    localizers_.push_back(make_localizer(setup, name, seed));
    localizers_.back()->reset(estimator.now, setup.prior);
  }
  attention_->follow(navigator_.path());
}

Outcome Loop::run() {
  MissionStart start{setup_, seed_, {}};
  for (const CameraFeed& camera : cameras_) start.eyes.push_back(&camera.eye());
  for (Listener* listener : listeners_) listener->on_start(start);
  log_.record(EventKind::plan, {{"length_m", setup_.path.length()}},
              {{"policy", setup_.look.policy}});
  std::optional<Outcome> end;
  while (!(end = outcome())) tick();
  finish(*end);
  return *end;
}

std::optional<Outcome> Loop::outcome() const {
  if (simulator_.clearance() < 0.0) return Outcome::collided;
  if (stays_lost_) return Outcome::lost;
  if (gave_up_) return Outcome::stuck;
  if (navigator_.arrived()) {
    const Eigen::Vector2d goal = setup_.path.points().back();
    const Eigen::Vector2d off = simulator_.robot().truth().pose.position() - goal;
    return off.norm() <= setup_.goal_tolerance_m ? Outcome::arrived : Outcome::stuck;
  }
  if (tick_.estimator.now.seconds() >= setup_.timeout_s) return Outcome::timeout;
  return std::nullopt;
}

void Loop::finish(Outcome outcome) {
  Event::Texts texts;
  if (outcome == Outcome::collided)
    texts.emplace_back("with", simulator_.clearance_of_people() < 0.0 ? "person" : "building");
  const Pose2& pose = simulator_.robot().truth().pose;
  log_.record(event_of(outcome), {{"x_m", pose.x}, {"y_m", pose.y}}, texts);
  for (Listener* listener : listeners_) listener->on_finish(outcome, tick_.estimator.now);
}

void Loop::tick() {
  const Stopwatch step;
  begin_tick();
  advance();
  const Readings readings = sense();
  predict(readings.odometry);
  const std::vector<Delivery> deliveries = deliver(readings);
  tick_.estimator.observations = observe(deliveries);
  tick_.estimator.localizers = update(tick_.estimator.observations);
  judge(readings, deliveries);
  ground_monitor_.judge(tick_.estimator);
  const Commands commands = recovering_ ? recover(readings, deliveries) : proceed(readings);
  simulator_.robot().command(commands.base, commands.head);
  complete_tick(readings, deliveries, commands);
  tick_.timing.step = step.elapsed_ms();
  for (Listener* listener : listeners_) listener->on_tick(tick_);
}

void Loop::begin_tick() {
  tick_.estimator.truth.emplace();
  tick_.activations.reset();
  tick_.eyes.clear();
  tick_.timing = {};
}

/// The world goes on: people, the robot under the rates that hold, whoever picks it up.
void Loop::advance() {
  const sim::Robot& robot = simulator_.robot();
  if (simulator_.kidnap()) {
    const Pose2& pose = robot.truth().pose;
    log_.record(EventKind::kidnapped,
                {{"x_m", pose.x}, {"y_m", pose.y}, {"theta_rad", pose.theta}});
  }
  tick_.estimator.truth->pose_before = robot.truth().pose;
  simulator_.advance(dt_);
  tick_.estimator.truth->pose = robot.truth().pose;
  if (!setup_.world.ground.flat()) tick_.estimator.truth->wMr = robot.wMr();
  tick_.estimator.now = tick_.estimator.now + dt_;
  log_.set_time(tick_.estimator.now);
}

Readings Loop::sense() {
  Readings readings;
  readings.now = tick_.estimator.now;
  readings.dt = dt_;
  readings.odometry = simulator_.robot().read_odometry();
  readings.head = simulator_.robot().read_head();
  travelled_m_ += std::abs(readings.odometry.trans);
  readings.travelled_m = travelled_m_;
  const double zoom_mm = readings.head.zoom_mm;
  for (const Camera& camera : rig_.cameras)
    readings.shots.push_back({readings.now, camera.id, camera.model(zoom_mm), readings.head.angles,
                              zoom_mm, on_head(camera) ? look_ : 0});
  return readings;
}

void Loop::predict(const OdometryIncrement& odometry) {
  const Stopwatch stopwatch;
  motion_.moved(odometry);
  for (const auto& localizer : localizers_) localizer->predict(odometry);
  tick_.timing.localize += stopwatch.elapsed_ms();
}

std::vector<Delivery> Loop::deliver(const Readings& readings) {
  std::vector<Delivery> deliveries;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const Shot& shot = readings.shots[i];
    cameras_[i].expose(simulator_, shot);
    auto exposure = cameras_[i].take(readings.now);
    if (!exposure) continue;
    const bool present = exposure->shot.look == shot.look;
    deliveries.emplace_back(cameras_[i].eye(), std::move(exposure), present);
    if (setup_.full_frames) imaging::grey_image(*deliveries.back().frame);
  }
  return deliveries;
}

std::vector<Observation> Loop::observe(const std::vector<Delivery>& deliveries) {
  const Stopwatch stopwatch;
  const auto request = attention_->request();
  std::vector<std::pair<Observation, ExposureTruth>> all;
  for (const Delivery& delivery : deliveries) {
    if (!delivery.present) continue;
    const Stamp exposed = delivery.exposure->shot.stamp;
    const Camera& camera = rig_.at(delivery.exposure->shot.camera);
    auto seen =
        delivery.eye->observe(delivery.capture(), motion_.belief_at(exposed, belief()), request);
    for (Observation& one : seen)
      all.emplace_back(std::move(one), truth_of(*delivery.exposure, camera));
  }
  // Motions first: what another camera shows at their end comes after them.
  std::stable_partition(all.begin(), all.end(), [](const auto& one) {
    return std::holds_alternative<FlowObservation>(one.first);
  });
  std::vector<Observation> observations;
  for (auto& [observation, truth] : all) {
    observations.push_back(std::move(observation));
    tick_.estimator.truth->exposures.push_back(truth);
  }
  tick_.timing.track += stopwatch.elapsed_ms();
  return observations;
}

std::vector<LocalizerTick> Loop::update(const std::vector<Observation>& observations) {
  const Stopwatch stopwatch;
  std::vector<LocalizerTick> ticks(localizers_.size());
  for (std::size_t i = 0; i < localizers_.size(); ++i) {
    for (const Observation& observation : observations)
      ticks[i].updates.push_back(localizers_[i]->update(observation));
    ticks[i].belief = &localizers_[i]->belief();
  }
  tick_.timing.localize += stopwatch.elapsed_ms();
  return ticks;
}

/// Attention and eyes learn what became of what was observed.
void Loop::judge(const Readings& readings, const std::vector<Delivery>& deliveries) {
  const EstimatorTick& estimator = tick_.estimator;
  const auto& results = estimator.localizers[estimator.primary].updates;
  for (std::size_t k = 0; k < results.size(); ++k)
    attention_->judge(estimator.observations[k], results[k], readings);
  rejections_.judge(estimator.observations, results);
  for (const Delivery& delivery : deliveries)
    if (delivery.present)
      delivery.eye->settle(motion_.belief_at(delivery.exposure->shot.stamp, belief()));
}

/// What a robot does that knows where it is, or finds out that it does not.
Commands Loop::proceed(const Readings& readings) {
  const Stopwatch stopwatch;
  const Demand demand = attention_->plan(readings, belief(), navigator_.station(), look_ + 1);
  tick_.timing.plan += stopwatch.elapsed_ms();
  if (demand.contradicted || ring_contradicts()) primary().lose();
  if (recovery_->asked(belief())) return begin_recovery(readings);
  if (demand.new_look) begin_look();
  const BaseRates base = drive(readings, demand.stop);
  return {base, steer(readings, base)};
}

bool Loop::ring_contradicts() const {
  return setup_.recovery.ring_probability < 1.0 &&
         ring_doubt_.probability() >= setup_.recovery.ring_probability;
}

void Loop::begin_look() {
  ++look_;
  simulator_.robot().begin_look();
}

BaseRates Loop::drive(const Readings& readings, bool hold) {
  const RangeScan scan = simulator_.scan();
  ring_doubt_.process(scan, belief());
  const NavigationStep step = navigator_.step(
      {readings.now, readings.odometry, belief(), scan.readings.empty() ? nullptr : &scan, hold});
  tick_.activations = step.activations;
  if (step.replanned) attention_->follow(navigator_.path());
  gave_up_ = gave_up_ || step.gave_up;
  return step.rates;
}

HeadRates Loop::steer(const Readings& readings, const BaseRates& base) {
  const Stopwatch stopwatch;
  const HeadRates head =
      attention_->steer(readings, belief(), base, tick_.estimator.observations, motion_);
  tick_.timing.servo += stopwatch.elapsed_ms();
  return head;
}

Commands Loop::begin_recovery(const Readings& readings) {
  lost_ = belief().status == BeliefStatus::lost;
  if (lost_)
    log_.record(EventKind::lost, {{"sigma_m", belief().position_sigma()}},
                {{"localizer", setup_.primary},
                 {"reason", ring_contradicts() ? "the range ring sees through the map's walls"
                                               : "landmarks are not where they should be"}});
  else
    log_.record(EventKind::ambiguous,
                {{"hypotheses", static_cast<double>(belief().hypotheses.size())}},
                {{"localizer", setup_.primary}});
  attention_->cancel();
  recovering_ = true;
  const RecoveryStep step = recovery_->begin(readings);
  if (step.new_look) begin_look();
  return step.commands;
}

Commands Loop::recover(const Readings& readings, const std::vector<Delivery>& deliveries) {
  const Stopwatch stopwatch;
  const std::function<RangeScan()> scan = [this] { return simulator_.scan(); };
  const RecoveryStep step = recovery_->step({readings, belief(), deliveries, scan});
  tick_.timing.track += stopwatch.elapsed_ms();
  tick_.activations = step.activations;
  if (step.new_look) begin_look();
  stays_lost_ = step.status == RecoveryStatus::gave_up;
  if (step.status == RecoveryStatus::found) recovered(step.pose);
  return step.commands;
}

void Loop::recovered(const std::optional<Prior>& pose) {
  if (pose) primary().reset(tick_.estimator.now, *pose);
  recovering_ = false;
  ring_doubt_.trust(simulator_.scan(), belief());
  const Pose2& here = belief().pose;
  log_.record(lost_ ? EventKind::recovered : EventKind::settled,
              {{"x_m", here.x},
               {"y_m", here.y},
               {"theta_rad", here.theta},
               {"sigma_m", belief().position_sigma()}});
  if (navigator_.replan(here, lost_ ? "recovered" : "settled")) {
    attention_->follow(navigator_.path());
    return;
  }
  log_.record(EventKind::stuck, {}, {{"reason", "no route from where the robot found itself"}});
  gave_up_ = true;
}

void Loop::complete_tick(const Readings& readings, const std::vector<Delivery>& deliveries,
                         const Commands& commands) {
  const EstimatorTick& estimator = tick_.estimator;
  tick_.estimator.odometry = readings.odometry;
  tick_.truth = simulator_.robot().truth();
  tick_.head = readings.head;
  tick_.base_command = commands.base;
  tick_.station_m = navigator_.station();
  tick_.attention = attention_->tick(readings, estimator.observations, look_);
  // The head searches whatever its attention was about.
  if (tick_.attention && recovering_) tick_.attention->gaze = GazeState::search;
  for (const Delivery& delivery : deliveries) {
    tick_.eyes.push_back({delivery.exposure->shot.camera, delivery.eye,
                          delivery.exposure->frame.get(), delivery.present});
    tick_.timing.render += delivery.frame->render_ms();
  }
  tick_.timing.track -= std::min(tick_.timing.track, tick_.timing.render);
}

}  // namespace vigia::mission
