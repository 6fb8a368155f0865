#include "sweep_recovery.hpp"

#include "localizer_params.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::mission {
namespace {

constexpr double kExploration_s = 12.0;
constexpr double kExplorationLength_m = 1.5;
constexpr double kMinExploration_m = 0.3;
constexpr double kEndMargin_m = 0.7;  // from the robot's centre to what stands at the end

/// The direction in which the ring has most room, and how far to go there; nothing when hemmed in.
std::optional<RangeReading> widest_direction(const RangeScan& scan) {
  const auto& ring = scan.readings;
  std::optional<RangeReading> widest;
  double best = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double left = ring[(i + 1) % ring.size()].range_m;
    const double right = ring[(i + ring.size() - 1) % ring.size()].range_m;
    const double room =
        std::min(std::min({left, ring[i].range_m, right}) - kEndMargin_m, kExplorationLength_m);
    // Rather ahead than back to where it came from.
    const double merit = room * (1.0 + 0.3 * std::cos(ring[i].bearing));
    if (room < kMinExploration_m || merit <= best) continue;
    best = merit;
    widest = RangeReading{ring[i].bearing, room, true};
  }
  return widest;
}

/// Even odds that the alarm was a false one.
constexpr double kFalseAlarm = 0.5;
/// That the robot is where no hypothesis of the sweep before has it.
constexpr double kElsewhere = 0.1;
/// σ of an exploration's odometry.
const Eigen::Vector3d kExplorationSigma(0.1, 0.1, from_deg(5.0));

/// What was believed, should the alarm have been a false one: a belief of twice the σ.
Prior doubted(const Belief& belief) {
  constexpr double kWider = 4.0;
  return {belief.pose, kWider * belief.covariance};
}

/// A hypothesis after the robot has moved by @p motion, by odometry.
PoseHypothesis moved(const PoseHypothesis& hypothesis, const Pose2& motion) {
  PoseHypothesis there = hypothesis;
  there.pose = compose(hypothesis.pose, motion);
  there.covariance += kExplorationSigma.cwiseAbs2().asDiagonal();
  return there;
}

std::optional<Prior> best_of(const localization::Relocalization& found) {
  if (found.status != localization::RelocalizationStatus::found) return std::nullopt;
  return Prior{found.hypotheses.front().pose, found.hypotheses.front().covariance};
}

}  // namespace

SweepRecovery::SweepRecovery(const MissionSetup& setup, perception::Eye& eye, EventLog& log)
    : setup_(setup),
      eye_(eye),
      log_(log),
      relocalizer_(setup.world.landmarks, setup.world.plan, setup.on_ground(),
                   relocalizer_params(setup)),
      look_around_(setup),
      knew_(setup.prior.has_value()) {}

RecoveryStep SweepRecovery::begin(const Readings& readings) {
  RecoveryStep step;
  sweep_ = {};
  begin_sweep(readings.head, step);
  step.commands.head = head_ = look_around_.step(readings.head);
  return step;
}

RecoveryStep SweepRecovery::step(const RecoveryInput& input) {
  const Readings& readings = input.readings;
  RecoveryStep step;
  if (answer_) {
    step.commands.head = head_;
    if (readings.now >= answer_->from) conclude(input, step);
    return step;
  }
  if (exploration_) {
    if (explore(input, step)) return step;
    exploration_.reset();
    begin_sweep(readings.head, step);
  }
  // The capture must have been exposed at this stop, standing still.
  const Delivery* delivery = delivered(input.deliveries);
  const Stamp exposed = delivery != nullptr ? delivery->exposure->shot.stamp : Stamp{};
  if (look_around_.ready(readings.now, readings.head, exposed)) {
    process(delivery->capture());
    if (!look_around_.next()) {
      think(input);
      step.commands.head = head_;
      return step;
    }
    step.new_look = true;
  }
  step.commands.head = head_ = look_around_.step(readings.head);
  return step;
}

void SweepRecovery::begin_sweep(const HeadReading& head, RecoveryStep& step, bool again) {
  step.new_look = true;
  look_around_.begin(head, again);
}

const Delivery* SweepRecovery::delivered(const std::vector<Delivery>& deliveries) const {
  for (const Delivery& delivery : deliveries)
    if (delivery.eye == &eye_ && delivery.present) return &delivery;
  return nullptr;
}

void SweepRecovery::process(const perception::Capture& capture) {
  sweep_.views.push_back(capture.shot);
  for (Observation& observation : eye_.survey(capture))
    sweep_.sightings.push_back(std::move(observation));
}

void SweepRecovery::think(const RecoveryInput& input) {
  head_ = {};
  const auto pose = relocalize(input.belief);
  answer_ = Answer{pose, input.readings.now + Duration::from_seconds(thought_s_)};
}

void SweepRecovery::conclude(const RecoveryInput& input, RecoveryStep& step) {
  step.pose = std::exchange(answer_, std::nullopt)->pose;
  if (step.pose) {
    step.status = RecoveryStatus::found;
    knew_ = true;
    alternatives_.reset();
    look_around_.found();
    return;
  }
  if (look_around_.sweeps() >= setup_.recovery.sweeps) {
    log_.record(EventKind::still_lost, {{"hypotheses", static_cast<double>(found_.size())}},
                {{"reason", found_.empty() ? "looked around in vain" : "several places fit"}});
    step.status = RecoveryStatus::gave_up;
    return;
  }
  if (!begin_exploration(input)) {
    // From the same place the same is seen: not to be counted again.
    begin_sweep(input.readings.head, step, true);
    return;
  }
  if (!found_.empty()) alternatives_ = Alternatives{std::exchange(found_, {}), input.belief.pose};
}

std::optional<Prior> SweepRecovery::relocalize(const Belief& belief) {
  const localization::Sweep sweep = std::exchange(sweep_, {});
  const auto found = relocalizer_.solve(sweep, place_prior(belief));
  found_ = found.hypotheses;
  thought_s_ = found.modelled_s;
  log_.record(EventKind::looked_around,
              {{"sightings", static_cast<double>(sweep.sightings.size())},
               {"hypotheses", static_cast<double>(found.hypotheses.size())},
               {"weight", found_.empty() ? 0.0 : found_.front().weight},
               {"fits", static_cast<double>(found.fits)},
               {"took_s", found.modelled_s}});
  if (auto here = best_of(found)) return here;
  if (!knew_ || alternatives_ || !found_.empty()) return std::nullopt;
  // The alarm may have been a false one: what was believed helps where too little is seen.
  return best_of(relocalizer_.confirm(sweep, doubted(belief)));
}

/// Before a sweep: what the sweep before left open, or what was believed, with doubt.
localization::PlacePrior SweepRecovery::place_prior(const Belief& belief) const {
  localization::PlacePrior place;
  if (alternatives_) {
    const Pose2 motion = compose(inverse(alternatives_->believed), belief.pose);
    for (const PoseHypothesis& hypothesis : alternatives_->hypotheses) {
      place.components.push_back(moved(hypothesis, motion));
      place.components.back().weight *= 1.0 - kElsewhere;
    }
  } else if (knew_) {
    const Prior believed = doubted(belief);
    place.components.push_back({believed.pose, believed.covariance, kFalseAlarm});
  }
  return place;
}

/// Where too little is seen, another place may show more: some steps to where the ring has most
/// room, by odometry alone.
bool SweepRecovery::begin_exploration(const RecoveryInput& input) {
  const auto direction = widest_direction(input.scan());
  if (!direction) return false;
  const Pose2& here = input.belief.pose;
  const Eigen::Vector2d from = here.position();
  const Eigen::Vector2d to =
      from + direction->range_m * unit_vector(here.theta + direction->bearing);
  exploration_.emplace(
      Exploration{pilot::Pilot(Path({from, to}), setup_.world.plan, setup_.robot.robot.radius_m,
                               setup_.robot.robot.base, setup_.pilot),
                  input.readings.now + Duration::from_seconds(kExploration_s)});
  log_.record(EventKind::exploration, {{"length_m", direction->range_m}});
  return true;
}

bool SweepRecovery::explore(const RecoveryInput& input, RecoveryStep& step) {
  if (input.readings.now >= exploration_->end) return false;
  const RangeScan scan = input.scan();
  const auto output = exploration_->pilot.step(
      {input.readings.now, input.readings.odometry, input.belief, &scan, false});
  step.activations = output.activations;
  const bool under_way =
      output.status != pilot::PilotStatus::arrived && output.status != pilot::PilotStatus::blocked;
  if (under_way) step.commands.base = output.rates;
  head_ = {};
  return under_way;
}

}  // namespace vigia::mission
