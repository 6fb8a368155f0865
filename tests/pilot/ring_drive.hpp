#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/random.hpp"
#include "vigia/pilot/pilot.hpp"

namespace vigia::pilot {

/// A round thing that the plan does not have. It moves at a constant velocity, but never nearer
/// than gives_way_m to the robot's hull.
struct Person {
  Eigen::Vector2d position;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  double radius_m = 0.25;
  double gives_way_m = 0.4;
};

/// The distance along a ray to a disc, or infinity.
inline double ray_to_disc(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                          const Eigen::Vector2d& centre, double radius_m) {
  const Eigen::Vector2d to = centre - origin;
  const double along = to.dot(direction);
  const double half2 = radius_m * radius_m - (to.squaredNorm() - along * along);
  if (half2 < 0.0 || along < 0.0) return std::numeric_limits<double>::infinity();
  return along - std::sqrt(half2);
}

/// A kinematic base under limits of acceleration at 25 Hz with a ring of 24 sonar-like beams, each
/// the nearest of the rays through its cone, in a room with people.
struct RingDrive {
  RingDrive(FloorPlan floor, const Path& path, const Pose2& start, PilotParams params = {})
      : plan(std::move(floor)), pilot(path, plan, kRadius, limits, params), pose(start) {
    belief.pose = start;
    belief.covariance = Eigen::Vector3d(4e-4, 4e-4, 1e-4).asDiagonal();
  }

  static constexpr double kRadius = 0.27;
  static constexpr double kTick = 0.04;

  RangeScan scan() {
    RangeScan result{Stamp::from_seconds(seconds), 4.0, {}};
    for (int i = 0; i < 24; ++i) {
      RangeReading reading{wrap_angle(from_deg(15.0 * i)), 4.0, false};
      double range = 4.0;
      for (int ray = -4; ray <= 4; ++ray)
        range = std::min(range, ray_range(reading.bearing + from_deg(7.5 * ray / 4.0)));
      if (range < 4.0) {
        reading.echo = true;
        reading.range_m = std::max(0.0, range + range_sigma_m * random.normal());
      }
      result.readings.push_back(reading);
    }
    return result;
  }

  double ray_range(double bearing) const {
    const double angle = pose.theta + bearing;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const auto wall = plan.cast(pose.position(), direction, 4.0);
    double range = wall ? wall->distance_m : 4.0;
    if (unknown_faces != nullptr)
      if (const auto hit = unknown_faces->cast(pose.position(), direction, 4.0))
        range = std::min(range, hit->distance_m);
    for (const Person& person : people)
      range = std::min(range,
                       ray_to_disc(pose.position(), direction, person.position, person.radius_m));
    return range;
  }

  /// Between the base's hull and the nearest person or wall, m.
  double clearance() const {
    double least = plan.clearance(pose.position());
    if (unknown_faces != nullptr)
      for (const Wall& face : unknown_faces->faces()) {
        const Eigen::Vector2d ab = face.b - face.a;
        const double t =
            std::clamp((pose.position() - face.a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (face.a + t * ab - pose.position()).norm());
      }
    for (const Person& person : people)
      least = std::min(least, (person.position - pose.position()).norm() - person.radius_m);
    return least - kRadius;
  }

  void walk() {
    for (Person& person : people) {
      const Eigen::Vector2d next = person.position + kTick * person.velocity;
      const double kept = kRadius + person.radius_m + person.gives_way_m;
      const double there = (next - pose.position()).norm();
      if (there > kept || there > (person.position - pose.position()).norm())
        person.position = next;
    }
  }

  void tick() {
    const Pose2 before = pose;
    walk();
    double turned = 0.0;
    for (int i = 0; i < 8; ++i) {
      constexpr double kStep = kTick / 8;
      rates.v += std::clamp(command.v - rates.v, -limits.acceleration * kStep,
                            limits.acceleration * kStep);
      rates.w += std::clamp(command.w - rates.w, -limits.turn_acceleration * kStep,
                            limits.turn_acceleration * kStep);
      pose = move(pose, arc_increment(rates.v, rates.w, Stamp{}, Stamp::from_seconds(kStep)));
      turned += rates.w * kStep;
    }
    seconds += kTick;
    const Stamp now = Stamp::from_seconds(seconds);
    const OdometryIncrement odometry = chord_increment(before, pose, turned, now - Duration{}, now);
    belief.pose = compose(pose, belief_error);
    RangeScan latest;
    if (ring) latest = scan();
    output = pilot.step({now, odometry, belief, ring ? &latest : nullptr, hold});
    command = output.rates;
    seen.insert(output.status);
    nearest = std::min(nearest, clearance());
    const Path& path = pilot.path();
    const double at = path.project(pose.position(), 0.0, path.length());
    farthest_off = std::max(farthest_off, (path.at(at) - pose.position()).norm());
  }

  bool run(double limit_s) {
    while (!pilot.arrived() && seconds < limit_s) tick();
    return pilot.arrived();
  }

  BaseLimits limits;
  FloorPlan plan;
  Pilot pilot;
  Pose2 pose;
  BaseRates rates;
  BaseRates command;
  Belief belief;
  Pose2 belief_error;
  std::vector<Person> people;
  const FloorPlan* unknown_faces = nullptr;  ///< walls that the pilot's plan lacks
  bool ring = true;
  bool hold = false;
  double range_sigma_m = 0.02;
  RandomStream random{1, "ring"};
  double seconds = 0.0;
  PilotOutput output;
  std::set<PilotStatus> seen;
  double nearest = 1e9;       ///< clearance so far
  double farthest_off = 0.0;  ///< from the path so far
};

}  // namespace vigia::pilot
