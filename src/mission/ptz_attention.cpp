#include "ptz_attention.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <utility>

#include "vigia/perception/landmark_image.hpp"

namespace vigia::mission {
namespace {

/// How far from the principal point the feature lies, px.
double off_centre(const Observation& observation) {
  const Intrinsics& camera = pinhole(shot_of(observation));
  return (image_extent(observation).centre - Eigen::Vector2d(camera.u0, camera.v0)).norm();
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

/// In whole ticks, beyond the first: in that one every camera exposes.
double pause_between_images_s(const Camera& camera, double tick_s) {
  constexpr double kRounding = 1e-9;
  return std::max(0.0, std::ceil(camera.period_s / tick_s - kRounding) - 1.0) * tick_s;
}

/// The params are those of a camera that exposes in every tick and delivers at once.
servo::GazeParams with_patience(servo::GazeParams params, double pause_s, double latency_s) {
  params.lost_grace_s += pause_s;
  params.acquire_s += pause_s + latency_s;
  return params;
}

}  // namespace

PtzAttention::PtzAttention(const MissionSetup& setup, const Camera& camera, std::uint64_t seed,
                           EventLog& log)
    : setup_(setup),
      camera_(camera.id),
      log_(log),
      on_ground_(setup.on_ground()),
      pause_s_(pause_between_images_s(camera, setup.tick_s)),
      latency_s_(camera.latency_s),
      information_(landmark_information(setup)),
      scheduler_(setup, information_, seed),
      gaze_(setup.robot.robot.head, setup.robot.robot.head_limits, setup.robot.zoom(),
            with_patience(setup.gaze, pause_s_, latency_s_), setup.world.ground),
      base_motion_({setup.robot.robot.base, setup.tick_s}) {}

void PtzAttention::follow(const Path& path) {
  path_m_ = path.length();
  scheduler_.follow(path);
}

std::optional<GazeRequest> PtzAttention::request() const {
  if (look_.request == TrackRequest::none || !gaze_.current()) return std::nullopt;
  return GazeRequest{gaze_.current()->landmark, look_.request};
}

void PtzAttention::judge(const Observation& observation, const localization::UpdateResult& result,
                         const Readings& readings) {
  if (shot_of(observation).camera != camera_ || !gaze_.current()) return;
  const LandmarkId landmark = gaze_.current()->landmark;
  if (result.status == localization::UpdateStatus::fused) {
    look_.rejected_in_a_row = 0;
    if (!look_.fused) scheduler_.fused(readings.travelled_m, landmark);
    look_.fused = true;
    failed_.clear();
    return;
  }
  if (result.status == localization::UpdateStatus::unsupported) return;
  if (look_.rejected_in_a_row++ == 0)
    log_.record(EventKind::rejected,
                {{"look", static_cast<double>(look_.id)},
                 {"landmark", static_cast<double>(landmark)},
                 {"nis", result.nis}},
                {{"reason", std::string(to_string(result.status))}});
}

Demand PtzAttention::plan(const Readings& readings, const Belief& belief, double station_m,
                          LookId next_look) {
  const Stamp now = readings.now;
  if (look_.rejected_in_a_row >= setup_.look.rejections_to_drop)
    drop("the filter rejects what is tracked", now);
  Demand demand;
  demand.contradicted = contradicts_belief();
  if (demand.contradicted || belief.status == BeliefStatus::lost) return demand;

  const auto wanted = scheduler_.demand(now, belief, readings.travelled_m, path_m_ - station_m);
  // A landmark that is not where the belief has it is reason enough to stand still.
  // Whom no ring warns does not drive on until the search has ended.
  const bool late = overdue(now) && !setup_.robot.range_ring;
  const bool suspicious = wanted == planner::LookDemand::stopped || !failed_.empty() || late;
  const bool idle = gaze_.state() == GazeState::idle;
  LookScheduler::Going going{station_m, readings.base_rates().v, suspicious};
  std::optional<LookScheduler::Decision> decision;
  if (idle && (suspicious || wanted != planner::LookDemand::none))
    decision = scheduler_.choose(now, belief, readings.head, going);
  // Two landmarks were not where they should be, and there is no third to ask.
  const bool nothing_to_ask = idle && !decision && !failed_.empty();
  demand.contradicted =
      (nothing_to_ask && different_failed() > 1) || held_up(readings, nothing_to_ask);
  if (demand.contradicted) return demand;

  // Where there is nothing to look at, standing helps nobody, unless no ring sees the walls.
  const bool blind = !failed_.empty() && !setup_.robot.range_ring;
  demand.stop = suspicious && (!idle || decision || blind);
  record_limits(wanted, demand.stop, belief.position_sigma());
  stopped_ = demand.stop;
  going.standing = demand.stop;
  demand.new_look = decision.has_value();
  if (decision) {
    decision->order.look = next_look;
    begin(*decision, readings, belief);
  }
  const bool waits = gaze_.state() == GazeState::idle;
  gaze_.rest_at(waits ? scheduler_.prepare(now, belief, readings.head, going) : std::nullopt);
  return demand;
}

void PtzAttention::begin(const LookScheduler::Decision& decision, const Readings& readings,
                         const Belief& belief) {
  const GazeOrder& order = decision.order;
  look_.id = order.look;
  look_.fused = false;
  look_.rejected_in_a_row = 0;
  gaze_.order(order);
  Event::Numbers numbers{{"look", static_cast<double>(order.look)},
                         {"landmark", static_cast<double>(order.landmark)},
                         {"sigma_m", belief.position_sigma()},
                         {"travelled_m", readings.travelled_m}};
  if (decision.suitability) numbers.emplace_back("suitability", *decision.suitability);
  if (order.zoom_mm) numbers.emplace_back("zoom_mm", *order.zoom_mm);
  log_.record(EventKind::look, std::move(numbers), {{"reason", decision.reason}});
}

void PtzAttention::drop(const std::string& reason, Stamp now) {
  const auto order = gaze_.current();
  look_.rejected_in_a_row = 0;
  if (!order) return;
  note_failure(order->landmark, now);
  log_.record(
      EventKind::dropped,
      {{"look", static_cast<double>(look_.id)}, {"landmark", static_cast<double>(order->landmark)}},
      {{"reason", reason}});
  gaze_.cancel();
  look_.request = TrackRequest::none;
  look_.acquired.reset();
}

void PtzAttention::cancel() {
  gaze_.cancel();
  look_.request = TrackRequest::none;
  look_.acquired.reset();
  failed_.clear();
  held_up_since_.reset();
}

void PtzAttention::note_failure(LandmarkId landmark, Stamp now) {
  scheduler_.failed(now, landmark);
  // What was seen at first may have been seen from where the robot has been taken away since. A
  // ring would tell; without one the robot stands until a landmark does.
  if (!look_.fused || !setup_.robot.range_ring) failed_.push_back(landmark);
}

std::size_t PtzAttention::different_failed() const {
  return std::set<LandmarkId>(failed_.begin(), failed_.end()).size();
}

bool PtzAttention::contradicts_belief() const {
  const auto enough = static_cast<std::size_t>(setup_.look.failures_to_lose);
  if (failed_.size() < enough) return false;
  return different_failed() > 1 || failed_.size() >= 2 * enough;
}

bool PtzAttention::held_up(const Readings& readings, bool nothing_to_ask) {
  constexpr double kPatience_s = 8.0;
  constexpr double kStanding_mps = 0.01;
  const bool stands = std::abs(readings.base_rates().v) < kStanding_mps;
  if (!nothing_to_ask || !stands)
    held_up_since_.reset();
  else if (!held_up_since_)
    held_up_since_ = readings.now;
  return held_up_since_ && (readings.now - *held_up_since_).seconds() >= kPatience_s;
}

bool PtzAttention::overdue(Stamp now) {
  constexpr double kSeenWithin_s = 0.2;
  const GazeState state = gaze_.state();
  const bool unseen =
      state == GazeState::acquire || state == GazeState::search || state == GazeState::lost;
  if (!unseen)
    aimed_since_.reset();
  else if (!aimed_since_)
    aimed_since_ = now;
  const double within_s = kSeenWithin_s + pause_s_ + latency_s_;
  return aimed_since_ && (now - *aimed_since_).seconds() > within_s;
}

/// The events of the two limits: limit_1, stop, restart.
void PtzAttention::record_limits(planner::LookDemand demand, bool stop, double sigma_m) {
  const bool over = setup_.look.trigger.kind == planner::LookTriggerParams::Kind::uncertainty &&
                    demand != planner::LookDemand::none;
  if (over && !over_limit_1_) log_.record(EventKind::limit_1, {{"sigma_m", sigma_m}});
  over_limit_1_ = over;
  if (stop == stopped_) return;
  const bool limit_2 = demand == planner::LookDemand::stopped;
  const Event::Texts why{{"reason", limit_2 ? "the uncertainty is above the second limit"
                                            : "a landmark was not where it should be"}};
  log_.record(stop ? EventKind::stop : EventKind::restart, {{"sigma_m", sigma_m}},
              stop ? why : Event::Texts{});
}

HeadRates PtzAttention::steer(const Readings& readings, const Belief& belief, const BaseRates& base,
                              const std::vector<Observation>& observations,
                              const RecentMotion& motion) {
  const BaseRates expected = base_motion_.expect(readings.base_rates(), base);
  const auto order = gaze_.current();
  servo::GazeInput input{readings.now, readings.head,          expected,
                         belief,       setup_.world.landmarks, pinhole(readings.shot_of(camera_)),
                         std::nullopt};
  if (const Observation* seen = seen_in(observations))
    input.sighting = sighting_now(readings, belief, *seen, motion);
  const servo::GazeOutput output = gaze_.step(input);
  if (order && output.event != servo::GazeEvent::none)
    record_gaze(output.event, order->landmark, readings.now);
  look_.request = output.request;
  return output.command;
}

void PtzAttention::record_gaze(servo::GazeEvent event, LandmarkId landmark, Stamp now) {
  if (event == servo::GazeEvent::acquired)
    look_.acquired = now;
  else
    look_.acquired.reset();
  if (event == servo::GazeEvent::expired) note_failure(landmark, now);
  log_.record(event_of(event), {{"look", static_cast<double>(look_.id)},
                                {"landmark", static_cast<double>(landmark)}});
}

const Observation* PtzAttention::seen_in(const std::vector<Observation>& observations) const {
  for (const Observation& observation : observations)
    if (shot_of(observation).camera == camera_) return &observation;
  return nullptr;
}

/// The feature where the belief's motion since its exposure has carried it.
std::optional<servo::GazeSighting> PtzAttention::sighting_now(const Readings& readings,
                                                              const Belief& belief,
                                                              const Observation& seen,
                                                              const RecentMotion& motion) const {
  // A look that was dropped in this tick, and perhaps followed by another, has no sighting.
  const Shot& then = shot_of(seen);
  if (!gaze_.current() || then.look != look_.id) return std::nullopt;
  const Landmark* landmark = setup_.world.landmarks.find(gaze_.current()->landmark);
  const ImageExtent extent = image_extent(seen, landmark);
  const servo::GazeSighting sighting{extent.centre, extent.radius_px};
  if (then.stamp == readings.now) return sighting;
  const auto moved =
      perception::image_motion(then, motion.belief_at(then.stamp, belief).pose,
                               readings.shot_of(camera_), belief.pose, *landmark, on_ground_);
  if (!moved) return sighting;
  return servo::GazeSighting{sighting.uv + moved->shift, sighting.radius_px * moved->growth};
}

std::optional<AttentionTick> PtzAttention::tick(const Readings& readings,
                                                const std::vector<Observation>& observations,
                                                LookId look) const {
  const Observation* seen = seen_in(observations);
  AttentionTick tick;
  tick.gaze = gaze_.state();
  tick.order = gaze_.current();
  tick.look = seen != nullptr ? shot_of(*seen).look : look;
  tick.stopped_to_look = stopped_;
  if (look_.acquired) {
    tick.tracked_s = (readings.now - *look_.acquired).seconds();
    if (seen != nullptr) tick.centring_px = off_centre(*seen);
  }
  return tick;
}

}  // namespace vigia::mission
