#include "vigia/sim/walkers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::sim {
namespace {

using Eigen::Vector2d;

constexpr int kWalkAttempts = 200;
constexpr double kForesight_s = 1.0;
constexpr std::array<double, 5> kInstants_s{0.1, 0.25, 0.5, 0.75, kForesight_s};
constexpr double kWalkFromWall = 0.05;   // m, beyond the radius
constexpr double kMinDistance = 0.1;     // m, from the robot's hull when there is no other way
constexpr double kTouching = 0.02;       // m, from the robot's hull: nobody steps nearer
constexpr double kFromEachOther = 0.15;  // m, between hulls, and never more than a radius
constexpr double kAtGoal = 0.15;         // m
constexpr double kFromStart = 1.2;       // m, from the robot's hull when the drive begins …
constexpr double kFromStartRadii = 6.0;  // … and never more than so many radii
constexpr double kLeg = 1.0;             // m, of a way at least …
constexpr double kLegRadii = 8.0;        // … and never more than so many radii
constexpr double kPatience = 2.0;        // times what the leg takes undisturbed
constexpr double kTurnRate = 4.0;        // rad/s

/// What small ones need: less room than people.
double room_between(const PeopleParams& params) {
  return std::min(kFromEachOther, params.radius_m);
}

}  // namespace

Walkers::Walkers(const PeopleParams& params, const FloorPlan& plan, const Bystander& robot,
                 std::uint64_t seed)
    : params_(params), plan_(plan), random_(seed, "people") {
  for (int i = 0; i < params_.count; ++i) {
    Walker walker;
    walker.position = walker.goal = free_place(robot);
    walker.pace = params_.speed_mps * random_.uniform(0.5, 1.0);
    walker.heading = random_.uniform(-kPi, kPi);
    walker.look = i;
    choose_goal(walker);
    walkers_.push_back(walker);
  }
}

Vector2d Walkers::free_place(const Bystander& robot) {
  const Vector2d low = plan_.min_corner();
  const Vector2d high = plan_.max_corner();
  Vector2d best = robot.position;
  double best_room = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kWalkAttempts; ++i) {
    const double x = random_.uniform(low.x(), high.x());
    const double y = random_.uniform(low.y(), high.y());
    const Vector2d p(x, y);
    double room = plan_.clearance(p) - params_.radius_m - kWalkFromWall;
    room = std::min(room, (p - robot.position).norm() - robot.radius_m - params_.radius_m -
                              std::min(kFromStart, kFromStartRadii * params_.radius_m));
    for (const Walker& other : walkers_)
      room = std::min(room,
                      (p - other.position).norm() - 2.0 * params_.radius_m - room_between(params_));
    if (room > best_room) {
      best = p;
      best_room = room;
    }
    if (room >= 0.0) break;
  }
  return best;
}

bool Walkers::straight_way(const Vector2d& from, const Vector2d& to) const {
  const double length = (to - from).norm();
  const int steps = 1 + static_cast<int>(length / 0.1);
  for (int i = 1; i <= steps; ++i)
    if (plan_.clearance(from + (to - from) * i / steps) < params_.radius_m + kWalkFromWall)
      return false;
  return true;
}

void Walkers::choose_goal(Walker& walker) {
  const Vector2d low = plan_.min_corner();
  const Vector2d high = plan_.max_corner();
  walker.goal = walker.position;
  for (int i = 0; i < kWalkAttempts && walker.goal == walker.position; ++i) {
    const double x = random_.uniform(low.x(), high.x());
    const double y = random_.uniform(low.y(), high.y());
    const Vector2d p(x, y);
    if ((p - walker.position).norm() > std::min(kLeg, kLegRadii * params_.radius_m) &&
        straight_way(walker.position, p))
      walker.goal = p;
  }
  walker.patience_s =
      2.0 + kPatience * (walker.goal - walker.position).norm() / std::max(walker.pace, 0.05);
}

double Walkers::room_on(const Walker& walker, const Vector2d& velocity, const Bystander& robot,
                        double distance_m) const {
  double room = std::numeric_limits<double>::infinity();
  for (const double t : kInstants_s) {
    const Vector2d p = walker.position + velocity * t;
    const Vector2d robot_then = robot.position + robot.velocity * t;
    room = std::min(room, (p - robot_then).norm() - robot.radius_m - params_.radius_m - distance_m);
    for (const Walker& other : walkers_) {
      if (&other == &walker) continue;
      room = std::min(room, (p - other.position - other.velocity * t).norm() -
                                2.0 * params_.radius_m - room_between(params_));
    }
    if (velocity.squaredNorm() > 0.0)
      room = std::min(room, plan_.clearance(p) - params_.radius_m - kWalkFromWall);
  }
  return room;
}

Vector2d Walkers::escape(const Walker& walker, const Bystander& robot) const {
  constexpr int kDirections = 24;
  constexpr double kTooNear = 20.0;  // m of way that a metre too near is worth
  constexpr double kResolve = 2.0;   // s/m: keeps on the way that he has taken
  const auto worth = [&](const Vector2d& velocity) {
    const double room = room_on(walker, velocity, robot, kMinDistance);
    const Vector2d apart =
        walker.position - robot.position + (velocity - robot.velocity) * kForesight_s;
    return apart.norm() + kTooNear * std::min(room, 0.0) + kResolve * velocity.dot(walker.velocity);
  };
  Vector2d best = Vector2d::Zero();
  double highest = worth(best);
  for (int i = 0; i < kDirections; ++i) {
    const Vector2d velocity = params_.speed_mps * unit_vector(2.0 * kPi * i / kDirections);
    const double value = worth(velocity);
    if (value <= highest) continue;
    best = velocity;
    highest = value;
  }
  return best;
}

Vector2d Walkers::choose_velocity(const Walker& walker, const Bystander& robot) const {
  Vector2d stand = Vector2d::Zero();
  const bool may_stand = room_on(walker, stand, robot, params_.distance_m) >= 0.0;
  if (walker.pause_s > 0.0 && may_stand) return stand;
  const Vector2d to_goal = walker.goal - walker.position;
  const double wanted =
      to_goal.norm() > 1e-6 ? std::atan2(to_goal.y(), to_goal.x()) : walker.heading;
  for (const double off : {0.0, 25.0, -25.0, 50.0, -50.0, 75.0, -75.0}) {
    Vector2d velocity = walker.pace * unit_vector(wanted + from_deg(off));
    if (room_on(walker, velocity, robot, params_.distance_m) >= 0.0) return velocity;
  }
  return may_stand ? stand : escape(walker, robot);
}

void Walkers::step(Walker& walker, double dt, const Bystander& robot) {
  walker.pause_s -= dt;
  walker.patience_s -= dt;
  const bool arrived = (walker.goal - walker.position).norm() < kAtGoal;
  if (walker.pause_s <= 0.0 && (arrived || walker.patience_s <= 0.0)) {
    choose_goal(walker);
    if (random_.uniform(0.0, 1.0) < params_.pause_probability)
      walker.pause_s = random_.uniform(0.0, params_.longest_pause_s);
  }
  walker.velocity = choose_velocity(walker, robot);
  Vector2d next = walker.position + walker.velocity * dt;
  // Nobody walks into the robot or a wall, whatever they foresaw.
  const double now_m = (walker.position - robot.position).norm();
  const double then_m = (next - robot.position).norm();
  const bool into_robot = then_m < now_m && then_m < robot.radius_m + params_.radius_m + kTouching;
  if (into_robot || plan_.clearance(next) < params_.radius_m) {
    walker.velocity.setZero();
    next = walker.position;
  }
  walker.stride_m += (next - walker.position).norm();
  walker.position = next;
  if (walker.velocity.squaredNorm() > 0.0) {
    const double turn =
        wrap_angle(std::atan2(walker.velocity.y(), walker.velocity.x()) - walker.heading);
    walker.heading = wrap_angle(walker.heading + std::clamp(turn, -kTurnRate * dt, kTurnRate * dt));
  }
}

void Walkers::advance(double dt, const Bystander& robot) {
  for (Walker& walker : walkers_) step(walker, dt, robot);
}

std::vector<Person> Walkers::people() const {
  std::vector<Person> people;
  for (const Walker& walker : walkers_)
    people.push_back({walker.position, walker.velocity, walker.heading, params_.radius_m,
                      params_.height_m, walker.stride_m, walker.velocity.squaredNorm() > 0.0,
                      walker.look,
                      params_.kind == PeopleParams::Kind::robots ? Figure::robot : Figure::person});
  return people;
}

std::vector<Pillar> Walkers::pillars() const {
  std::vector<Pillar> pillars;
  for (const Walker& walker : walkers_)
    pillars.push_back({walker.position, params_.radius_m, params_.height_m});
  return pillars;
}

double Walkers::clearance(const Vector2d& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Walker& walker : walkers_)
    nearest = std::min(nearest, (walker.position - p).norm() - params_.radius_m);
  return nearest;
}

}  // namespace vigia::sim
