#pragma once

#include "event_log.hpp"
#include "look_around.hpp"
#include "recovery.hpp"

#include <optional>

#include "vigia/localization/relocalizer.hpp"
#include "vigia/pilot/pilot.hpp"

namespace vigia::mission {

/// The recovery of a robot with a head: it stands still and looks around, and what it sees, all at
/// once, tells where it is: discs, patterns and tags together. It stands still until the time that
/// the search takes has passed. Where too little is seen, or where what is seen fits several
/// places, it goes to where the range ring has most room, and looks around there; what fitted
/// before weighs the places. One of several is never taken for the only one.
class SweepRecovery : public Recovery {
 public:
  /// @p eye: of the camera that the head turns. All references outlive the recovery.
  SweepRecovery(const MissionSetup& setup, perception::Eye& eye, EventLog& log);

  RecoveryStep begin(const Readings& readings) override;
  RecoveryStep step(const RecoveryInput& input) override;

 private:
  /// On the way to another place to look around from.
  struct Exploration {
    pilot::Pilot pilot;
    Stamp end;
  };

  void begin_sweep(const HeadReading& head, RecoveryStep& step, bool again = false);
  /// What the eye's camera has delivered that was exposed in the present look.
  const Delivery* delivered(const std::vector<Delivery>& deliveries) const;
  void process(const perception::Capture& capture);
  /// Searches, and has the answer once the time for it has passed.
  void think(const RecoveryInput& input);
  void conclude(const RecoveryInput& input, RecoveryStep& step);
  std::optional<Prior> relocalize(const Belief& belief);
  localization::PlacePrior place_prior(const Belief& belief) const;
  bool begin_exploration(const RecoveryInput& input);
  /// Whether the robot is still on its way.
  bool explore(const RecoveryInput& input, RecoveryStep& step);

  const MissionSetup& setup_;
  perception::Eye& eye_;
  EventLog& log_;
  localization::Relocalizer relocalizer_;
  LookAround look_around_;
  localization::Sweep sweep_;
  /// What the last sweep has shown, from a time on.
  struct Answer {
    std::optional<Prior> pose;
    Stamp from;
  };
  std::optional<Answer> answer_;
  double thought_s_ = 0.0;  ///< by the last search, in modelled time
  std::optional<Exploration> exploration_;
  /// What the sweep before the last exploration left open, and what was believed then: the
  /// odometry from there carries the hypotheses on.
  struct Alternatives {
    std::vector<PoseHypothesis> hypotheses;
    Pose2 believed;
  };
  std::optional<Alternatives> alternatives_;
  std::vector<PoseHypothesis> found_;  ///< by the last sweep
  HeadRates head_;                     ///< asked for last
  bool knew_;                          ///< where it was, some time before it was lost
};

}  // namespace vigia::mission
