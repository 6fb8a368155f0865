#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/round_obstacle.hpp"
#include "vigia/pilot/pilot_params.hpp"

namespace vigia::pilot {

/// A detour beside the path: points of the world from the robot on.
using Detour = std::vector<Eigen::Vector2d>;

/// Finds the cheapest detour along lanes beside a path: a lattice of stations × lateral offsets,
/// searched by dynamic programming. A detour costs its length, its distance from the path and its
/// closeness to things; it keeps AvoidanceParams::wall_m from walls.
class Lanes {
 public:
  Lanes(const FloorPlan& plan, double robot_radius_m, AvoidanceParams params)
      : plan_(&plan), robot_radius_m_(robot_radius_m), params_(params) {}

  /// The detour from @p robot, which is at @p station of @p path, that keeps @p beside_m from the
  /// things; nothing when every one is blocked. A detour found before holds later ones to its side
  /// of the path until forget(), so that the robot does not dither before what it could pass on
  /// both.
  std::optional<Detour> search(const Path& path, double station, const Eigen::Vector2d& robot,
                               const std::vector<RoundObstacle>& things, double beside_m);

  void forget() { side_ = 0.0; }

 private:
  struct Node {
    Eigen::Vector2d p;
    double risk = 0.0;
    double cost = 0.0;
    int previous = -1;
  };

  /// Cost of standing at a node; infinite when the robot does not fit.
  double risk(const Eigen::Vector2d& p, bool on_path,
              const std::vector<RoundObstacle>& things) const;
  /// Whether the robot goes straight from @p p to @p q between the things.
  bool passes(const Eigen::Vector2d& p, const Eigen::Vector2d& q,
              const std::vector<RoundObstacle>& things) const;
  void lay_out(const Path& path, const std::vector<double>& stations,
               const std::vector<RoundObstacle>& things);
  void link_first(const Eigen::Vector2d& robot, const std::vector<RoundObstacle>& things);
  void link(int layer, const std::vector<RoundObstacle>& things);
  Node& node(int layer, int lane) {
    return nodes_[static_cast<std::size_t>(layer) * static_cast<std::size_t>(lanes_) +
                  static_cast<std::size_t>(lane)];
  }
  /// Cost of being on a lane, for the length of a step.
  double aside(int lane) const;
  int middle() const { return lanes_ / 2; }
  double offset(int lane) const { return params_.lane_m * (lane - middle()); }

  const FloorPlan* plan_;
  double robot_radius_m_;
  AvoidanceParams params_;
  double beside_m_ = 0.0;
  double side_ = 0.0;  ///< 1: the latest detour was on the left of the path, -1: on its right
  int lanes_ = 1;
  std::vector<Node> nodes_;
};

}  // namespace vigia::pilot
