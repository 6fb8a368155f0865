#pragma once

#include "camera_feed.hpp"
#include "readings.hpp"

#include <functional>
#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/range_scan.hpp"
#include "vigia/pilot/pilot.hpp"

namespace vigia::mission {

enum class RecoveryStatus { searching, found, gave_up };

/// What a lost robot does until the next tick.
struct RecoveryStep {
  RecoveryStatus status = RecoveryStatus::searching;
  std::optional<Prior> pose;  ///< found: where the primary localizer begins anew; nothing: it knows
  Commands commands;
  /// A look begins: the readings' constant errors are others from now on.
  bool new_look = false;
  std::optional<pilot::Activations> activations;  ///< while it drives
};

/// What a lost robot has in a tick.
struct RecoveryInput {
  const Readings& readings;
  const Belief& belief;  ///< of the primary localizer, carried on by odometry
  const std::vector<Delivery>& deliveries;
  const std::function<RangeScan()>& scan;  ///< asks the ring; without one, no readings
};

/// What a robot does whose primary localizer is lost, or knows too little to be driven by.
class Recovery {
 public:
  virtual ~Recovery() = default;
  /// Whether a robot with such a belief should do it, and not follow its path.
  virtual bool asked(const Belief& belief) const { return belief.status == BeliefStatus::lost; }
  /// The first step, in the tick in which the belief asks for it.
  virtual RecoveryStep begin(const Readings& readings) = 0;
  /// In each of the ticks after it, until it has found the robot or given up.
  virtual RecoveryStep step(const RecoveryInput& input) = 0;
};

}  // namespace vigia::mission
