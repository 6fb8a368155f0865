#pragma once

#include "blockages.hpp"
#include "late_frames.hpp"
#include "look_around.hpp"
#include "look_scheduler.hpp"
#include "timed_frame.hpp"
#include "watcher.hpp"

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "vigia/localization/points_information.hpp"
#include "vigia/localization/relocalizer.hpp"
#include "vigia/mission/mission.hpp"
#include "vigia/pilot/pilot.hpp"
#include "vigia/servo/base_motion.hpp"

namespace vigia::mission {

/// One mission in progress: the tick of the design's loop, part by part.
class Loop {
 public:
  Loop(const MissionSetup& setup, std::uint64_t seed, const std::vector<Listener*>& listeners);

  Outcome run();

 private:
  const Belief& belief() const { return localizers_[primary_]->belief(); }

  void tick();
  void predict();
  void watch(const imaging::Frame& frame);
  void localize(const Observation& observation);
  void plan();
  void steer();
  void recover(const imaging::Frame* frame);
  std::optional<servo::GazeSighting> sighting_now() const;
  void begin_recovery();
  void begin_sweep();
  void begin_stroll();
  bool stroll_on();
  void read_code(const PointsObservation& seen);
  void relocalize();
  void recovered(const Prior& here);
  BaseRates drive();
  void tell_pilot(const pilot::PilotOutput& output);
  void go_round(const pilot::PilotOutput& output);
  bool replan(const Pose2& from, const std::string& reason,
              const std::vector<RoundObstacle>& others = {});
  void note_failure(LandmarkId landmark);
  void begin_look(const LookScheduler::Decision& decision);
  /// Landmarks at which the looks since the last fused one showed nothing.
  std::size_t different_failed() const;
  /// One landmark that fails again and again is missing; several are a sign of being elsewhere.
  bool nothing_is_where_it_should_be() const;
  void drop_look(const std::string& reason);
  /// The story of the two limits: limit_1, stop, restart.
  void tell_limits(planner::LookDemand demand, bool stop);
  void tell_gaze(servo::GazeEvent event, LandmarkId landmark);
  std::optional<Outcome> outcome() const;

  using Texts = std::vector<std::pair<std::string, std::string>>;
  using Numbers = std::vector<std::pair<std::string, double>>;
  void tell(const std::string& kind, const Numbers& numbers = {}, const Texts& texts = {}) const;

  const MissionSetup& setup_;
  std::uint64_t seed_;
  Rig rig_;
  const std::vector<Listener*>& listeners_;

  sim::Simulator simulator_;
  std::vector<std::unique_ptr<localization::Localizer>> localizers_;
  std::size_t primary_ = 0;
  localization::LandmarkInformation information_;
  localization::Relocalizer relocalizer_;
  LookScheduler scheduler_;
  Watcher watcher_;
  servo::GazeController gaze_;
  servo::BaseMotion base_motion_;
  pilot::Pilot pilot_;
  pilot::PilotStatus pilot_status_ = pilot::PilotStatus::driving;
  bool evading_ = false;
  Blockages blockages_;
  LookAround look_around_;
  std::vector<Eigen::Vector2d> waypoints_;  ///< of the path that the pilot follows

  LateFrames late_frames_;
  RecentMotion motion_;
  std::unique_ptr<ExposedFrame> delivered_;  ///< the frame that arrived in this tick

  Stamp now_;
  Duration dt_;
  OdometryIncrement odometry_;
  HeadReading head_;
  Shot shot_;
  BaseRates command_;
  double travelled_m_ = 0.0;
  bool stopped_to_look_ = false;
  bool over_limit_1_ = false;
  std::optional<Outcome> gave_up_;

  servo::TrackRequest request_ = servo::TrackRequest::none;
  LookId look_ = 0;
  std::optional<Stamp> acquired_;
  int rejected_in_a_row_ = 0;
  std::vector<LandmarkId> failed_;  ///< looks in a row that ended without anything fused
  bool look_fused_ = false;

  bool recovering_ = false;
  localization::Sweep sweep_;
  std::optional<pilot::Pilot> stroll_;  ///< on the way to another place to look around from
  Stamp stroll_end_;
  std::optional<Prior> by_code_;  ///< what a pattern of the sweep said

  // What this tick tells its listeners.
  std::vector<LocalizerTick> localizer_ticks_;
  std::optional<Sighting> sighting_;
  std::optional<Observation> observation_;
  std::optional<pilot::Activations> activations_;
  TickTiming timing_;
};

}  // namespace vigia::mission
