#pragma once

#include <set>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/range_scan.hpp"
#include "vigia/core/stamp.hpp"

namespace vigia::mission {

/// How a ring of range sensors is believed to measure.
struct RingModel {
  double half_cone = from_deg(7.5);  ///< rad
  double sigma_m = 0.02;
  double sigma_relative = 0.01;
  double height_m = 0.3;  ///< above the floor: what is lower gives no echo
};

/// Doubts a belief by the range ring: a beam that sees through a wall of the map contradicts the
/// pose. A beam that ends before its wall contradicts nothing, since a map lacks people and boxes;
/// what the beam would hit is bounded from above by rays within its cone, narrowed by the belief's
/// heading. The evidence of a scan is the likelihood ratio of its long and its right beams,
/// tempered, as successive scans share whatever is wrong with the map.
class RingDoubt {
 public:
  RingDoubt(const FloorPlan& plan, const RingModel& model) : plan_(plan), model_(model) {}

  /// At most one scan every period counts.
  void process(const RangeScan& scan, const Belief& belief);
  /// That the robot is not where the belief has it, by what the ring has shown.
  double probability() const;
  /// The robot has found itself by landmarks: what the ring then sees through is no longer there,
  /// and counts no more.
  void trust(const RangeScan& scan, const Belief& belief);

 private:
  enum class Verdict { untested, right, longer };
  struct Beam {
    Verdict verdict = Verdict::untested;
    std::size_t face = 0;  ///< that it should have met
  };
  std::vector<Beam> compare(const RangeScan& scan, const Belief& belief) const;

  const FloorPlan& plan_;
  RingModel model_;
  std::set<std::size_t> absent_;  ///< faces that are not there
  double log_odds_ = 0.0;         ///< beyond those of a robot that has seen nothing
  Stamp counted_;
};

}  // namespace vigia::mission
