#include "wander_recovery.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/pilot/pursuit.hpp"

namespace vigia::mission {
namespace {

constexpr double kBerth = 1.75;         // radii of the base, within which nothing is to be
constexpr double kWanderBlocked = 0.1;  // radii that are not worth going on for
constexpr double kWanderHorizon_m = 4.0;
constexpr int kWanderDirections = 16;
constexpr double kRatherAhead = 0.3;
constexpr double kTurned = from_deg(2.0);

/// In a direction, by the ring: until a disc would touch what a beam has met.
double ring_room(const RangeScan& scan, double turn, double radius_m, double horizon_m) {
  double room = horizon_m;
  for (const RangeReading& reading : scan.readings) {
    if (!reading.echo) continue;
    const double off = wrap_angle(reading.bearing - turn);
    const double beside = reading.range_m * std::sin(off);
    if (std::abs(beside) >= radius_m || std::cos(off) <= 0.0) continue;
    const double along = reading.range_m * std::cos(off);
    room = std::min(room, along - std::sqrt(radius_m * radius_m - beside * beside));
  }
  return std::max(room, 0.0);
}

}  // namespace

WanderRecovery::WanderRecovery(const MissionSetup& setup, EventLog& log)
    : setup_(setup),
      log_(log),
      berth_m_(kBerth * setup.robot.robot.radius_m),
      risk_(setup.world.plan, berth_m_, setup.recovery.contact_risk),
      pursuit_(setup.robot.robot.base, kTurned) {
  const BaseLimits& base = setup.robot.robot.base;
  stopping_m_ = base.speed * base.speed / (2.0 * base.acceleration);
}

bool WanderRecovery::asked(const Belief& belief) const {
  if (belief.status == BeliefStatus::lost) return true;
  if (belief.status != BeliefStatus::ambiguous || belief.hypotheses.empty()) return false;
  return risk_.free_m(belief, 0.0, stopping_m_) < stopping_m_;
}

RecoveryStep WanderRecovery::begin(const Readings& readings) {
  since_ = readings.now;
  turn_left_ = 0.0;
  return {};
}

RecoveryStep WanderRecovery::step(const RecoveryInput& input) {
  RecoveryStep step;
  if (input.belief.status == BeliefStatus::tracking) {
    step.status = RecoveryStatus::found;
    return step;
  }
  const Duration since = input.readings.now - since_;
  if (since.seconds() >= setup_.recovery.wander_s) {
    const bool several = input.belief.status == BeliefStatus::ambiguous;
    log_.record(EventKind::still_lost,
                {{"hypotheses", static_cast<double>(input.belief.hypotheses.size())}},
                {{"reason", several ? "several places fit, and nothing on the way told them apart"
                                    : "no eye has shown where it is"}});
    step.status = RecoveryStatus::gave_up;
    return step;
  }
  if (input.belief.status == BeliefStatus::ambiguous && !input.belief.hypotheses.empty())
    step.commands.base = wander(input);
  return step;
}

double WanderRecovery::room(const RecoveryInput& input, const RangeScan& scan, double turn) const {
  const double free_m = risk_.free_m(input.belief, turn, kWanderHorizon_m);
  return std::min(free_m, ring_room(scan, turn, berth_m_, kWanderHorizon_m));
}

/// The turn after which there is most room, rather ahead than back; none where it is hemmed in.
void WanderRecovery::choose(const RecoveryInput& input, const RangeScan& scan) {
  turn_left_ = 0.0;
  double best = 0.0;
  for (int i = 1; i < kWanderDirections; ++i) {
    const double turn = wrap_angle(2.0 * kPi * i / kWanderDirections);
    const double free_m = room(input, scan, turn);
    const double merit = free_m * (1.0 + kRatherAhead * std::cos(turn));
    if (free_m < setup_.robot.robot.radius_m || merit <= best) continue;
    best = merit;
    turn_left_ = turn;
  }
}

BaseRates WanderRecovery::wander(const RecoveryInput& input) {
  const BaseLimits& base = setup_.robot.robot.base;
  const OdometryIncrement& odometry = input.readings.odometry;
  turn_left_ = wrap_angle(turn_left_ - odometry.rot1 - odometry.rot2);
  double speed = base.speed;
  if (std::abs(turn_left_) <= kTurned) {
    turn_left_ = 0.0;
    const RangeScan scan = input.scan();
    const double ahead_m = room(input, scan, 0.0);
    if (ahead_m < kWanderBlocked * setup_.robot.robot.radius_m) choose(input, scan);
    speed = std::min(speed, pilot::braking_rate(base.acceleration, ahead_m));
  }
  return pursuit_.step(unit_vector(turn_left_), speed);
}

}  // namespace vigia::mission
