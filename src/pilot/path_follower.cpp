#include "vigia/pilot/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::pilot {
namespace {

constexpr double kStationWindow = 0.5;     // m that the station may advance in one step
constexpr double kCornerReached = 0.02;    // m before a corner at which the turn begins
constexpr double kStraightInto = 1.0;      // m before a passage, from where the way is straight
constexpr double kBendInto = from_deg(4);  // that is turned on the spot there

bool leads_into(double station, const std::vector<Passage>& passages) {
  return std::any_of(passages.begin(), passages.end(), [station](const Passage& passage) {
    return station >= passage.begin_m - kStraightInto && station <= passage.end_m;
  });
}

std::vector<double> stops_of(const Path& path, double corner,
                             const std::vector<Passage>& passages) {
  std::vector<double> stops;
  const auto& points = path.points();
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d in = points[i] - points[i - 1];
    const Eigen::Vector2d out = points[i + 1] - points[i];
    const double bend = std::atan2(cross(in, out), in.dot(out));
    const double sharp = leads_into(path.stations()[i], passages) ? kBendInto : corner;
    if (std::abs(bend) > sharp) stops.push_back(path.stations()[i]);
  }
  stops.push_back(path.length());
  return stops;
}

}  // namespace

PathFollower::PathFollower(Path path, BaseLimits limits, PathFollowerParams params,
                           const std::vector<Passage>& passages)
    : path_(std::move(path)),
      limits_(limits),
      params_(params),
      stops_(stops_of(path_, from_deg(params.corner_deg), passages)),
      pursuit_(limits, from_deg(params.turn_in_place_deg)) {}

void PathFollower::skip_to(double station) {
  station_ = std::clamp(station, station_, path_.length());
  while (stretch_ + 1 < stops_.size() && stops_[stretch_] <= station_) ++stretch_;
}

void PathFollower::advance(const Pose2& estimate) {
  const Eigen::Vector2d p = estimate.position();
  station_ = path_.project(p, station_, std::min(station_ + kStationWindow, stops_[stretch_]));
  const bool last = stretch_ + 1 == stops_.size();
  if (!last && stops_[stretch_] - station_ <= kCornerReached) {
    station_ = stops_[stretch_];
    ++stretch_;
    pursuit_.begin_turn();
  }
  if (last && (path_.points().back() - p).norm() <= params_.goal_tolerance_m) {
    station_ = path_.length();
    arrived_ = true;
  }
}

Eigen::Vector2d PathFollower::pursued(const Pose2& estimate) const {
  const double stop = stops_[stretch_];
  const bool last = stretch_ + 1 == stops_.size();
  Eigen::Vector2d target = path_.at(std::min(station_ + params_.lookahead_m, stop));
  const double beyond = station_ + params_.lookahead_m - stop;
  // Short of a corner the line is thought to go on, so that the pursuit stays smooth up to it. At
  // the path's end there is nothing left to follow but the end itself.
  if (beyond > 0.0 && !(last && station_ >= stop)) {
    const double heading = path_.heading(stop - 1e-6);
    target += beyond * unit_vector(heading);
  }
  const Eigen::Vector2d d = target - estimate.position();
  const double c = std::cos(estimate.theta);
  const double s = std::sin(estimate.theta);
  return {c * d.x() + s * d.y(), -s * d.x() + c * d.y()};
}

double PathFollower::speed_limit() const {
  const double left = stops_[stretch_] - station_;
  if (stretch_ + 1 < stops_.size())
    return std::min(limits_.speed, braking_rate(limits_.acceleration, left));
  // Never so slow that the end is not reached: the last centimetres are the tolerance's.
  const double floor = params_.goal_tolerance_m;
  return limits_.speed * std::clamp(std::max(left, floor) / params_.slow_down_m, 0.0, 1.0);
}

BaseRates PathFollower::step(const Pose2& estimate) {
  if (!arrived_) advance(estimate);
  if (arrived_) return {};

  return pursuit_.step(pursued(estimate), speed_limit());
}

}  // namespace vigia::pilot
