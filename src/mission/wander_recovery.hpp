#pragma once

#include "event_log.hpp"
#include "recovery.hpp"

#include "vigia/mission/setup.hpp"
#include "vigia/pilot/contact_risk.hpp"
#include "vigia/pilot/pursuit.hpp"

namespace vigia::mission {

/// Of a robot that has no head to look around with. While its primary localizer is lost it stands
/// still and is offered what its eyes observe. While it may be at several places, and its path
/// would take it into the building from one of them, it wanders: straight on as far as no
/// hypothesis of weight touches anything, then off in the direction with most room, since what
/// tells places apart comes into view on the way. It ends when the localizer tracks, or after
/// RecoveryParams::wander_s.
class WanderRecovery : public Recovery {
 public:
  WanderRecovery(const MissionSetup& setup, EventLog& log);

  bool asked(const Belief& belief) const override;
  RecoveryStep begin(const Readings& readings) override;
  RecoveryStep step(const RecoveryInput& input) override;

 private:
  BaseRates wander(const RecoveryInput& input);
  double room(const RecoveryInput& input, const RangeScan& scan, double turn) const;
  void choose(const RecoveryInput& input, const RangeScan& scan);

  const MissionSetup& setup_;
  EventLog& log_;
  double berth_m_;  ///< radius of what is kept free
  pilot::ContactRisk risk_;
  double stopping_m_;  ///< from full speed
  Stamp since_;
  pilot::Pursuit pursuit_;
  double turn_left_ = 0.0;  ///< rad
};

}  // namespace vigia::mission
