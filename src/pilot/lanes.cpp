#include "lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

constexpr double kStep = 0.25;      // m between two stations of the lattice
constexpr int kLanesAStep = 2;      // that a detour may change between two stations
constexpr double kOffPath = 0.3;    // cost per metre driven and metre of offset
constexpr double kOtherSide = 0.6;  // per metre on the side that was not chosen
constexpr double kSoft = 0.30;      // m from a thing within which closeness costs
constexpr double kCloseness = 0.4;  // per station, right beside a thing
constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::vector<double> stations_ahead(const Path& path, double station, double horizon) {
  std::vector<double> result;
  const double end = std::min(station + horizon, path.length());
  for (double s = station + kStep; s < end - 0.5 * kStep; s += kStep) result.push_back(s);
  result.push_back(end);
  return result;
}

}  // namespace

double Lanes::aside(int lane) const {
  const double off = offset(lane);
  return kStep * (kOffPath * std::abs(off) + (off * side_ < 0.0 ? kOtherSide : 0.0));
}

double Lanes::risk(const Vector2d& p, bool on_path,
                   const std::vector<RoundObstacle>& things) const {
  double closeness = 0.0;
  for (const RoundObstacle& thing : things) {
    const double free = (p - thing.centre).norm() - thing.radius_m - robot_radius_m_;
    if (free < beside_m_) return kInfinite;
    closeness = std::max(closeness, 1.0 - (free - beside_m_) / kSoft);
  }
  // The path itself is the route's business: it may lead through a narrow door.
  if (!on_path && plan_->clearance(p) < robot_radius_m_ + params_.wall_m) return kInfinite;
  return kCloseness * std::max(closeness, 0.0);
}

bool Lanes::passes(const Vector2d& p, const Vector2d& q,
                   const std::vector<RoundObstacle>& things) const {
  return std::all_of(things.begin(), things.end(), [&](const RoundObstacle& thing) {
    const double needed = thing.radius_m + robot_radius_m_ + beside_m_;
    // A robot that is too near already may go away.
    const double here = (p - thing.centre).norm();
    return distance_to_segment(thing.centre, p, q) >= std::min(needed - 0.03, here - 1e-9);
  });
}

void Lanes::lay_out(const Path& path, const std::vector<double>& stations,
                    const std::vector<RoundObstacle>& things) {
  nodes_.assign(stations.size() * static_cast<std::size_t>(lanes_), {});
  for (std::size_t layer = 0; layer < stations.size(); ++layer) {
    const double heading = path.heading(std::min(stations[layer], path.length() - 1e-6));
    const Vector2d normal(-std::sin(heading), std::cos(heading));
    const Vector2d on_path = path.at(stations[layer]);
    for (int lane = 0; lane < lanes_; ++lane) {
      Node& n = node(static_cast<int>(layer), lane);
      n.p = on_path + offset(lane) * normal;
      n.risk = risk(n.p, lane == middle(), things);
      n.cost = kInfinite;
    }
  }
}

void Lanes::link_first(const Vector2d& robot, const std::vector<RoundObstacle>& things) {
  for (int lane = 0; lane < lanes_; ++lane) {
    Node& n = node(0, lane);
    if (std::isinf(n.risk) || !passes(robot, n.p, things)) continue;
    n.cost = (n.p - robot).norm() + aside(lane) + n.risk;
  }
}

void Lanes::link(int layer, const std::vector<RoundObstacle>& things) {
  for (int lane = 0; lane < lanes_; ++lane) {
    Node& n = node(layer, lane);
    if (std::isinf(n.risk)) continue;
    for (int from = std::max(0, lane - kLanesAStep);
         from <= std::min(lanes_ - 1, lane + kLanesAStep); ++from) {
      const Node& before = node(layer - 1, from);
      const double step = (n.p - before.p).norm();
      const double cost = before.cost + step + aside(lane) + n.risk;
      if (cost >= n.cost || !passes(before.p, n.p, things)) continue;
      n.cost = cost;
      n.previous = from;
    }
  }
}

std::optional<Detour> Lanes::search(const Path& path, double station, const Vector2d& robot,
                                    const std::vector<RoundObstacle>& things, double beside_m) {
  beside_m_ = beside_m;
  const std::vector<double> stations = stations_ahead(path, station, params_.horizon_m);
  lanes_ = 2 * static_cast<int>(params_.widest_m / params_.lane_m) + 1;
  lay_out(path, stations, things);
  link_first(robot, things);
  const int layers = static_cast<int>(stations.size());
  for (int layer = 1; layer < layers; ++layer) link(layer, things);

  // At the path's end only the end itself will do.
  const bool to_the_end = stations.back() >= path.length();
  int best = middle();
  for (int lane = 0; lane < lanes_ && !to_the_end; ++lane)
    if (node(layers - 1, lane).cost < node(layers - 1, best).cost) best = lane;
  if (std::isinf(node(layers - 1, best).cost)) return std::nullopt;

  Detour detour;
  double area = 0.0;
  for (int layer = layers - 1, lane = best; layer >= 0;
       lane = node(layer, lane).previous, --layer) {
    detour.push_back(node(layer, lane).p);
    area += offset(lane);
  }
  if (side_ == 0.0 && area != 0.0) side_ = std::copysign(1.0, area);
  detour.push_back(robot);
  std::reverse(detour.begin(), detour.end());
  return detour;
}

}  // namespace vigia::pilot
