#pragma once

#include "attention.hpp"
#include "camera_feed.hpp"
#include "event_log.hpp"
#include "ground_monitor.hpp"
#include "late_frames.hpp"
#include "navigator.hpp"
#include "recovery.hpp"
#include "ring_doubt.hpp"
#include "undirected_rejections.hpp"

#include <memory>
#include <optional>
#include <vector>

#include "vigia/mission/mission.hpp"

namespace vigia::mission {

/// One mission in progress: the tick of the design's loop, part by part. Which eyes, attention and
/// recovery a robot has follows from its rig; the loop knows none of them by name.
class Loop {
 public:
  Loop(const MissionSetup& setup, std::uint64_t seed, const std::vector<Listener*>& listeners);

  Outcome run();

 private:
  void tick();
  void begin_tick();
  void advance();
  Readings sense();
  void predict(const OdometryIncrement& odometry);
  std::vector<Delivery> deliver(const Readings& readings);
  std::vector<Observation> observe(const std::vector<Delivery>& deliveries);
  std::vector<LocalizerTick> update(const std::vector<Observation>& observations);
  void judge(const Readings& readings, const std::vector<Delivery>& deliveries);
  Commands proceed(const Readings& readings);
  void begin_look();
  BaseRates drive(const Readings& readings, bool hold);
  HeadRates steer(const Readings& readings, const BaseRates& base);
  bool ring_contradicts() const;
  Commands begin_recovery(const Readings& readings);
  Commands recover(const Readings& readings, const std::vector<Delivery>& deliveries);
  void recovered(const std::optional<Prior>& pose);
  void complete_tick(const Readings& readings, const std::vector<Delivery>& deliveries,
                     const Commands& commands);

  std::optional<Outcome> outcome() const;
  void finish(Outcome outcome);
  localization::Localizer& primary() const { return *localizers_[tick_.estimator.primary]; }
  const Belief& belief() const { return primary().belief(); }

  const MissionSetup& setup_;
  std::uint64_t seed_;
  const std::vector<Listener*>& listeners_;
  EventLog log_;
  sim::Simulator simulator_;
  Rig rig_;
  std::vector<CameraFeed> cameras_;  ///< in the rig's order
  std::vector<std::unique_ptr<localization::Localizer>> localizers_;
  std::unique_ptr<Attention> attention_;
  UndirectedRejections rejections_;
  GroundMonitor ground_monitor_;
  std::unique_ptr<Recovery> recovery_;
  RingDoubt ring_doubt_;
  Navigator navigator_;
  RecentMotion motion_;
  Duration dt_;
  double travelled_m_ = 0.0;
  LookId look_ = 0;
  bool recovering_ = false;
  bool lost_ = false;  ///< recovering, because of a belief that was lost
  bool gave_up_ = false;
  bool stays_lost_ = false;  ///< the recovery has given up
  Tick tick_;                ///< what this tick tells its listeners
};

}  // namespace vigia::mission
