#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/round_obstacle.hpp"

namespace vigia::planner {

/// Distance between the segments a0–a1 and b0–b1 in the plane; 0 when they meet.
double segment_distance(const Eigen::Vector2d& a0, const Eigen::Vector2d& a1,
                        const Eigen::Vector2d& b0, const Eigen::Vector2d& b1);

/// Where a disc of a radius fits, exactly: no sampling along a motion. The plan must outlive it.
class RoomToMove {
 public:
  RoomToMove(const FloorPlan& plan, double radius_m, const std::vector<RoundObstacle>& others = {})
      : plan_(&plan), others_(others), radius_m_(radius_m) {}

  double radius() const { return radius_m_; }
  const FloorPlan& plan() const { return *plan_; }

  const std::vector<RoundObstacle>& others() const { return others_; }

  /// Distance from @p p to the nearest face or obstacle, negative in a solid or outside the room.
  double clearance(const Eigen::Vector2d& p) const;
  bool fits(const Eigen::Vector2d& p) const { return clearance(p) >= radius_m_; }

  /// Whether the disc can go straight from @p a to @p b, both of which must lie on the free side of
  /// every face (fits() says so).
  bool passes(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;

  /// The nearest place on rings around @p p where the disc fits and which a smaller disc, of the
  /// clearance at @p p, reaches straight from there; @p p itself when the disc fits there.
  std::optional<Eigen::Vector2d> retreat(const Eigen::Vector2d& p) const;

 private:
  const FloorPlan* plan_;
  std::vector<RoundObstacle> others_;
  double radius_m_;
};

}  // namespace vigia::planner
