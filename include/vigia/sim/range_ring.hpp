#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/angle.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/random.hpp"
#include "vigia/core/range_scan.hpp"
#include "vigia/core/sector.hpp"

namespace vigia::sim {

/// A ring of sonars round the base, as the B21 carries one. Beam i looks along 2πi/beams.
struct RangeRingParams {
  int beams = 24;
  double reach_m = 4.0;
  double sigma_m = 0.02;         ///< constant part of an echo's σ
  double sigma_relative = 0.01;  ///< part of σ that grows with the range
  double cone = from_deg(15.0);  ///< full opening angle of a beam, rad
  double height_m = 0.3;         ///< above the floor: what is lower gives no echo
  double dropout = 0.02;         ///< share of echoes that do not come back
};

/// Something round and upright that stands on the floor.
struct Pillar {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius_m = 0.25;
  double height_m = 1.75;
};

/// Distance from @p p to the nearest point that a cone sees of faces and pillars higher than
/// @p above_m, or nothing within @p reach_m. The cone opens by @p cone < π about @p direction (rad,
/// world); what lies nearest in it is never hidden, so no ray needs casting.
std::optional<double> nearest_in_cone(const FloorPlan& plan, const std::vector<Pillar>& pillars,
                                      const Eigen::Vector2d& p, double direction, double cone,
                                      double reach_m, double above_m);

/// Reads a ring of sensors round the robot out of the true world.
class RangeRing {
 public:
  RangeRing(const RangeRingParams& params, std::uint64_t seed);

  /// One reading of every beam; the noise of a reading is drawn anew each time.
  RangeScan scan(Stamp stamp, const Pose2& pose, const FloorPlan& plan,
                 const std::vector<Pillar>& pillars);

 private:
  RangeRingParams params_;
  RandomStream random_;
  std::vector<double> bearings_;  ///< of the beams, from the robot's front, rad
  std::vector<Sector> beams_;     ///< about the robot's front
};

}  // namespace vigia::sim
