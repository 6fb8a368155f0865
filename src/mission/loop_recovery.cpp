#include "localizer_params.hpp"
#include "loop.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/localization/pattern_fix.hpp"

namespace vigia::mission {
namespace {

constexpr double kStroll_s = 12.0;
constexpr double kStrollLength_m = 1.5;
constexpr double kStrollLeast_m = 0.3;
constexpr double kStrollMargin_m = 0.7;  // from the robot's centre to what stands at the end

/// The direction in which the ring has most room, and how far to go there; nothing when hemmed in.
std::optional<RangeReading> widest_way(const RangeScan& scan) {
  const auto& ring = scan.readings;
  std::optional<RangeReading> widest;
  double best = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double left = ring[(i + 1) % ring.size()].range_m;
    const double right = ring[(i + ring.size() - 1) % ring.size()].range_m;
    const double room =
        std::min(std::min({left, ring[i].range_m, right}) - kStrollMargin_m, kStrollLength_m);
    // Rather ahead than back to where it came from.
    const double merit = room * (1.0 + 0.3 * std::cos(ring[i].bearing));
    if (room < kStrollLeast_m || merit <= best) continue;
    best = merit;
    widest = RangeReading{ring[i].bearing, room, true};
  }
  return widest;
}

/// A belief that has been called into question: half a metre and 10° more than it says.
Prior doubtful(const Belief& belief) {
  Prior prior{belief.pose, belief.covariance};
  prior.covariance.diagonal() += Eigen::Vector3d(0.25, 0.25, from_deg(10.0) * from_deg(10.0));
  return prior;
}

std::optional<Prior> best_of(const localization::Relocalization& found) {
  if (found.status != localization::RelocalizationStatus::found) return std::nullopt;
  return Prior{found.hypotheses.front().pose, found.hypotheses.front().covariance};
}

}  // namespace

// The lost robot stands still and looks around; what it sees, all at once, tells where it is.

void Loop::begin_recovery() {
  tell("lost", {{"sigma_m", belief().position_sigma()}}, {{"localizer", setup_.primary}});
  gaze_.cancel();
  request_ = servo::TrackRequest::none;
  acquired_.reset();
  recovering_ = true;
  failed_.clear();
  sweep_ = {};
  begin_sweep();
}

void Loop::recover(const imaging::Frame* frame) {
  command_ = {};
  if (stroll_) {
    if (stroll_on()) return;
    stroll_.reset();
    begin_sweep();
  }
  // The frame must have been exposed at this stop, standing still.
  const Stamp exposed = frame != nullptr ? delivered_->shot.stamp : Stamp{};
  if (look_around_.ready(now_, head_, exposed)) {
    const Stopwatch watch;
    const Shot& shot = delivered_->shot;
    for (auto& seen : watcher_.survey(*frame, shot)) sweep_.sightings.push_back(seen);
    sweep_.views.push_back(shot);
    for (const auto& seen : watcher_.survey_points(*frame, shot)) read_code(seen);
    timing_.track += watch.elapsed_ms();
    if (!look_around_.next()) {
      relocalize();
      return;
    }
    look_ = scheduler_.next_look();
    simulator_.robot().begin_look();
  }
  simulator_.robot().command(command_, look_around_.step(head_));
}

/// A pattern says who it is and where the robot stands: the surest one of a sweep counts.
void Loop::read_code(const PointsObservation& seen) {
  localization::PatternFixLocalizer fix(setup_.world.landmarks, setup_.on_ground(),
                                        pattern_fix_params(setup_));
  fix.reset(shot_of(seen).stamp, {});
  if (fix.update(seen).status != localization::UpdateStatus::fused) return;
  const Prior found{fix.belief().pose, fix.belief().covariance};
  if (!by_code_ || found.covariance.trace() < by_code_->covariance.trace()) by_code_ = found;
}

void Loop::relocalize() {
  const auto found = relocalizer_.solve(sweep_);
  tell("looked_around", {{"sightings", static_cast<double>(sweep_.sightings.size())},
                         {"hypotheses", static_cast<double>(found.hypotheses.size())}});
  const localization::Sweep sweep = std::exchange(sweep_, {});
  std::optional<Prior> here = std::exchange(by_code_, std::nullopt);
  if (!here) here = best_of(found);
  // The alarm may have been a false one: what was believed helps where too little is seen.
  if (!here) here = best_of(relocalizer_.solve(sweep, doubtful(belief())));
  if (here) {
    recovered(*here);
    return;
  }
  if (look_around_.sweeps() >= setup_.recovery.sweeps) {
    tell("stuck", {}, {{"reason", "looked around in vain"}});
    gave_up_ = Outcome::stuck;
    return;
  }
  begin_stroll();
  if (!stroll_) begin_sweep();
}

void Loop::begin_sweep() {
  look_ = scheduler_.next_look();
  simulator_.robot().begin_look();
  look_around_.begin(head_);
}

/// Where too little is seen, another place may show more: some steps to where the ring has most
/// room, by odometry alone.
void Loop::begin_stroll() {
  const RangeScan scan = simulator_.scan();
  const auto way = widest_way(scan);
  if (!way) return;
  const Eigen::Vector2d from = belief().pose.position();
  const double heading = belief().pose.theta + way->bearing;
  const Eigen::Vector2d to = from + way->range_m * unit_vector(heading);
  stroll_.emplace(Path({from, to}), setup_.world.plan, setup_.robot.robot.radius_m,
                  setup_.robot.robot.base, setup_.pilot);
  stroll_end_ = now_ + Duration::from_seconds(kStroll_s);
  tell("stroll", {{"length_m", way->range_m}});
}

bool Loop::stroll_on() {
  if (now_ >= stroll_end_) return false;
  const RangeScan scan = simulator_.scan();
  const auto output = stroll_->step({now_, odometry_, belief(), &scan, false});
  activations_ = output.activations;
  const bool under_way =
      output.status != pilot::PilotStatus::arrived && output.status != pilot::PilotStatus::blocked;
  command_ = under_way ? output.rates : BaseRates{};
  simulator_.robot().command(command_, {});
  return under_way;
}

void Loop::recovered(const Prior& here) {
  localizers_[primary_]->reset(now_, here);
  recovering_ = false;
  look_around_.found();
  tell("recovered", {{"x_m", here.pose.x},
                     {"y_m", here.pose.y},
                     {"theta_rad", here.pose.theta},
                     {"sigma_m", belief().position_sigma()}});
  if (replan(here.pose, "recovered")) return;
  tell("stuck", {}, {{"reason", "no route from where the robot found itself"}});
  gave_up_ = Outcome::stuck;
}

}  // namespace vigia::mission
