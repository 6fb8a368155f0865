#pragma once

#include <cstdint>
#include <vector>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/random.hpp"
#include "vigia/sim/body.hpp"
#include "vigia/sim/disturbances.hpp"
#include "vigia/sim/range_ring.hpp"

namespace vigia::sim {

/// The robot as people see it.
struct Bystander {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  double radius_m = 0.3;
};

/// People who walk between random places of a room in straight legs, pause now and then, and give
/// way to the robot and to each other: of the directions about the one they want to go they take
/// the first that stays clear for the next second, and stand still when none does. Cornered they
/// run.
class Walkers {
 public:
  Walkers(const PeopleParams& params, const FloorPlan& plan, const Bystander& robot,
          std::uint64_t seed);

  void advance(double dt, const Bystander& robot);

  /// As the camera sees them now.
  std::vector<Person> people() const;
  /// As the range sensors do.
  std::vector<Pillar> pillars() const;
  /// Distance from the nearest one's hull to a point; infinite without people.
  double clearance(const Eigen::Vector2d& p) const;

 private:
  struct Walker {
    Eigen::Vector2d position;
    Eigen::Vector2d goal;
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
    double heading = 0.0;
    double pace = 0.6;        ///< m/s when nothing is in the way
    double pause_s = 0.0;     ///< left to stand
    double patience_s = 0.0;  ///< left to reach the goal, before another is chosen
    double stride_m = 0.0;    ///< walked so far
    int look = 0;             ///< of the clothes
  };

  Eigen::Vector2d free_place(const Bystander& robot);
  void choose_goal(Walker& walker);
  bool straight_way(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  /// The smallest distance to spare within the next second on this course, when @p distance_m is
  /// kept from the robot's hull; negative: blocked.
  double room_on(const Walker& walker, const Eigen::Vector2d& velocity, const Bystander& robot,
                 double distance_m) const;
  /// Cornered: as fast as he can to where the robot will be farthest, past it if need be.
  Eigen::Vector2d escape(const Walker& walker, const Bystander& robot) const;
  Eigen::Vector2d choose_velocity(const Walker& walker, const Bystander& robot) const;
  void step(Walker& walker, double dt, const Bystander& robot);

  PeopleParams params_;
  FloorPlan plan_;
  RandomStream random_;
  std::vector<Walker> walkers_;
};

}  // namespace vigia::sim
