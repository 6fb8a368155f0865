#pragma once

#include "vigia/core/belief.hpp"
#include "vigia/core/floor_plan.hpp"

namespace vigia::pilot {

/// How far a robot that may be at several places can drive straight on, until it would touch the
/// building from places that together have more than a stated weight.
class ContactRisk {
 public:
  /// @p plan must outlive it; the base is a disc of @p robot_radius_m; @p risk in [0, 1) is a
  /// weight of hypotheses.
  ContactRisk(const FloorPlan& plan, double robot_radius_m, double risk);

  /// Metres, at most @p horizon_m, in the direction @p turn (rad, from each hypothesis's heading
  /// to the left). Each hypothesis is taken three of its σ nearer to what stands before it; one
  /// that lies outside of the building or inside an obstacle is none. A belief without hypotheses
  /// is its pose.
  double free_m(const Belief& belief, double turn, double horizon_m) const;

 private:
  double free_from(const PoseHypothesis& hypothesis, double turn, double horizon_m) const;

  const FloorPlan& plan_;
  double radius_m_;
  double risk_;
};

}  // namespace vigia::pilot
