#include "vigia/pilot/pilot.hpp"

#include "echo_memory.hpp"
#include "executor.hpp"
#include "known_walls.hpp"
#include "lanes.hpp"
#include "passage_guard.hpp"
#include "supervisor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

constexpr double kUnblocked = std::numeric_limits<double>::infinity();
constexpr double kPathStep = 0.10;       // m between the places on the path that are tried
constexpr double kBesideWindow = 0.5;    // m that the station may advance in one step off the path
constexpr double kAhead = 0.35;          // m, of the point that is pursued on the detour
constexpr double kProgress = 0.15;       // m along the path that count as progress
constexpr double kSearchEvery = 0.2;     // s between two searches for a detour
constexpr double kStands = 0.02;         // m/s below which the base is said to wait
constexpr double kNearerOnDetour = 0.6;  // of the distance from things, once the detour is driven

Vector2d to_world(const Pose2& base, const Vector2d& p_r) {
  const double c = std::cos(base.theta);
  const double s = std::sin(base.theta);
  return base.position() + Vector2d(c * p_r.x() - s * p_r.y(), s * p_r.x() + c * p_r.y());
}

Vector2d to_base(const Pose2& base, const Vector2d& p_w) {
  const double c = std::cos(base.theta);
  const double s = std::sin(base.theta);
  const Vector2d d = p_w - base.position();
  return {c * d.x() + s * d.y(), -s * d.x() + c * d.y()};
}

/// Where along the path something blocks it.
struct Blockade {
  double ahead_m = kUnblocked;
  std::optional<Vector2d> thing;
};

Blockade first_blockade(const Path& path, double station, double notice, double clearance,
                        const std::vector<RoundObstacle>& things) {
  if (things.empty()) return {};
  const double end = std::min(station + notice, path.length());
  for (double s = station; s <= end; s += kPathStep) {
    const Vector2d p = path.at(s);
    for (const RoundObstacle& thing : things)
      if ((thing.centre - p).norm() < thing.radius_m + clearance)
        return {s - station, thing.centre};
  }
  return {};
}

}  // namespace

std::string_view to_string(PilotStatus status) {
  switch (status) {
    case PilotStatus::driving:
      return "driving";
    case PilotStatus::holding:
      return "holding";
    case PilotStatus::evading:
      return "evading";
    case PilotStatus::waiting:
      return "waiting";
    case PilotStatus::blocked:
      return "blocked";
    case PilotStatus::arrived:
      return "arrived";
  }
  return "?";
}

struct Pilot::Impl {
  Impl(Path path, const FloorPlan& floor, double radius, BaseLimits base, const PilotParams& p)
      : plan(&floor),
        robot_radius_m(radius),
        limits(base),
        params(p),
        guard(floor, radius, base, p.ring),
        follower(start_of(std::move(path))),
        memory(p.ring),
        lanes(floor, radius, p.avoidance),
        executor(radius, base, p.avoidance),
        detour_pursuit(base, from_deg(p.follower.turn_in_place_deg)) {}

  /// A follower of @p path, whose passages the guard knows.
  PathFollower start_of(Path path) {
    guard.follow(path);
    return {std::move(path), limits, params.follower, guard.passages()};
  }
  void look(const PilotInput& input);
  void plan_detour(const PilotInput& input, const Pose2& base,
                   const std::vector<RoundObstacle>& things);
  void drop_detour();
  BaseRates avoid(const Pose2& base);
  void keep_station(const Pose2& base, const Blockade& blockade);
  PilotStatus status(const PilotInput& input, const PilotOutput& output, bool cut) const;
  bool report_blocked(PilotStatus status, double dt);
  std::vector<RoundObstacle> things(const Pose2& base) const;

  const FloorPlan* plan;
  double robot_radius_m;
  BaseLimits limits;
  PilotParams params;
  PassageGuard guard;
  PathFollower follower;
  EchoMemory memory;
  Lanes lanes;
  Executor executor;
  Pursuit detour_pursuit;  ///< of the detour

  std::optional<Stamp> scanned;
  std::optional<Stamp> stepped;
  std::optional<Stamp> searched;
  std::vector<Hazard> hazards;
  std::vector<char> unexplained;
  std::optional<Path> detour;
  bool evading = false;
  double lasted_s = 0.0;  ///< of the path's being blocked
  double mark_m = 0.0;    ///< the station of the latest progress
  double stalled_s = 0.0;
  double unreported_s = 0.0;  ///< stalled since `blocked` was last said
};

void Pilot::Impl::look(const PilotInput& input) {
  memory.carry(input.odometry);
  memory.forget(input.now);
  if (input.scan == nullptr || (scanned && *scanned == input.scan->stamp)) return;
  scanned = input.scan->stamp;
  const RangeScan& scan = *input.scan;
  const Pose2& base = guard.base(input.belief);
  const PoseDoubt doubt = guard.doubt(input.belief);
  hazards.clear();
  unexplained.assign(scan.readings.size(), 0);
  for (std::size_t i = 0; i < scan.readings.size(); ++i) {
    const RangeReading& reading = scan.readings[i];
    if (!reading.echo || reading.range_m > params.ring.horizon_m) continue;
    const double sigma =
        std::hypot(params.ring.sigma_m, params.ring.sigma_relative * reading.range_m);
    const bool known =
        explained(reading, *plan, base, doubt, from_deg(params.ring.half_angle_deg), sigma);
    unexplained[i] = known ? 0 : 1;
    hazards.push_back({reading.range_m * unit_vector(reading.bearing), known});
  }
  memory.take(scan, unexplained);
}

std::vector<RoundObstacle> Pilot::Impl::things(const Pose2& base) const {
  std::vector<RoundObstacle> result;
  const double radius = params.ring.thing_radius_m;
  for (const Echo& echo : memory.echoes()) {
    if (!memory.confirmed(echo)) continue;
    const double range = std::max(echo.front_r.norm(), 1e-6);
    result.push_back({to_world(base, echo.front_r * (1.0 + radius / range)), radius});
  }
  return result;
}

void Pilot::Impl::plan_detour(const PilotInput& input, const Pose2& base,
                              const std::vector<RoundObstacle>& things) {
  const Duration every = Duration::from_seconds(kSearchEvery);
  if (searched && input.now - *searched < every) return;
  searched = input.now;
  const double beside = params.avoidance.beside_m * (evading ? kNearerOnDetour : 1.0);
  const auto found =
      lanes.search(follower.path(), follower.station(), base.position(), things, beside);
  detour.reset();
  if (found) detour.emplace(*found);
}

void Pilot::Impl::drop_detour() {
  detour.reset();
  lanes.forget();
  searched.reset();
}

BaseRates Pilot::Impl::avoid(const Pose2& base) {
  const Vector2d here = base.position();
  const double reached = detour->project(here, 0.0, std::min(detour->length(), 2.0 * kAhead));
  const Vector2d target = detour->at(reached + kAhead);
  return detour_pursuit.step(to_base(base, target), std::min(params.avoidance.speed, limits.speed));
}

/// Beside the path the station goes on, and the path is followed again once it is reached.
void Pilot::Impl::keep_station(const Pose2& base, const Blockade& blockade) {
  const Path& path = follower.path();
  const double from = follower.station();
  const double at =
      path.project(base.position(), from, std::min(from + kBesideWindow, path.length()));
  follower.skip_to(at);
  const double off = (path.at(at) - base.position()).norm();
  if (off > params.avoidance.rejoin_m || std::isfinite(blockade.ahead_m)) return;
  evading = false;
  drop_detour();
}

PilotStatus Pilot::Impl::status(const PilotInput& input, const PilotOutput& output,
                                bool cut) const {
  if (follower.arrived()) return PilotStatus::arrived;
  if (input.hold) return PilotStatus::holding;
  if (output.activations.hold > 0.5 || cut) return PilotStatus::waiting;
  return evading ? PilotStatus::evading : PilotStatus::driving;
}

/// Keeps the clocks of a robot that does not get on; true when it is time to say so.
bool Pilot::Impl::report_blocked(PilotStatus status, double dt) {
  if (follower.station() > mark_m + kProgress) {
    mark_m = follower.station();
    stalled_s = 0.0;
    unreported_s = 0.0;
  }
  if (status != PilotStatus::waiting && status != PilotStatus::evading) return false;
  stalled_s += dt;
  unreported_s += dt;
  if (unreported_s < params.avoidance.blocked_s) return false;
  unreported_s = 0.0;
  return true;
}

Pilot::Pilot(Path path, const FloorPlan& plan, double robot_radius_m, BaseLimits limits,
             PilotParams params)
    : impl_(std::make_unique<Impl>(std::move(path), plan, robot_radius_m, limits, params)) {}
Pilot::~Pilot() = default;
Pilot::Pilot(Pilot&&) noexcept = default;
Pilot& Pilot::operator=(Pilot&&) noexcept = default;

PilotOutput Pilot::step(const PilotInput& input) {
  Impl& self = *impl_;
  const AvoidanceParams& avoidance = self.params.avoidance;
  const double dt = self.stepped ? (input.now - *self.stepped).seconds() : 0.0;
  self.stepped = input.now;
  self.guard.sense(input, self.follower.station());
  const Pose2 base = self.guard.base(input.belief);
  self.look(input);

  const auto things = self.things(base);
  const Blockade blockade =
      first_blockade(self.follower.path(), self.follower.station(), avoidance.notice_m,
                     self.robot_radius_m + avoidance.corridor_m, things);
  const bool blocked = std::isfinite(blockade.ahead_m);
  if (self.evading) self.keep_station(base, blockade);
  if (blocked || self.evading || self.lasted_s > 0.0)
    self.plan_detour(input, base, things);
  else
    self.drop_detour();

  PilotOutput output;
  output.obstacle_ahead = blockade.thing;
  output.activations =
      supervise({input.hold, blockade.ahead_m, self.lasted_s, self.evading,
                 self.detour.has_value() && !self.guard.inside(self.follower.station())},
                avoidance);
  const Activations& a = output.activations;
  if (a.avoid > 0.5) self.evading = true;

  const PassageOrder order = input.hold
                                 ? PassageOrder{self.limits.speed, false, std::nullopt}
                                 : self.guard.order(input.belief, self.follower.station(), dt);
  output.refused = order.refused;
  BaseRates fused;
  if (a.follow > 0.0 && !self.evading) {
    const BaseRates follow = self.follower.step(base);
    fused = {a.follow * follow.v, a.follow * follow.w};
  }
  if (a.avoid > 0.0) {
    const BaseRates avoid = self.avoid(base);
    fused = {fused.v + a.avoid * avoid.v, fused.w + a.avoid * avoid.w};
  }
  if (order.hold) fused = {};
  if (fused.v > order.speed) fused = {order.speed, fused.w * order.speed / fused.v};
  output.rates = self.executor.execute(
      fused, self.guard.hazards(self.hazards, self.memory, input.belief), self.guard.beside_m());
  const bool cut = output.rates.v < kStands && fused.v > kStands;
  self.lasted_s =
      std::clamp(self.lasted_s + (blocked || cut ? dt : -2.0 * dt), 0.0, avoidance.patience_s);
  output.station_m = self.follower.station();
  output.status = self.status(input, output, cut);
  if (self.report_blocked(output.status, dt)) output.status = PilotStatus::blocked;
  return output;
}

void Pilot::follow(Path path) {
  Impl& self = *impl_;
  self.follower = self.start_of(std::move(path));
  self.drop_detour();
  self.evading = false;
  self.lasted_s = 0.0;
  self.mark_m = 0.0;
  self.unreported_s = 0.0;
}

bool Pilot::arrived() const {
  return impl_->follower.arrived();
}
double Pilot::station() const {
  return impl_->follower.station();
}
const Path& Pilot::path() const {
  return impl_->follower.path();
}
double Pilot::stalled_s() const {
  return impl_->stalled_s;
}
std::vector<RoundObstacle> Pilot::obstacles(const Pose2& base) const {
  return impl_->things(base);
}

}  // namespace vigia::pilot
