#pragma once

#include "attention.hpp"
#include "event_log.hpp"
#include "look_scheduler.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vigia/mission/planning_parts.hpp"
#include "vigia/servo/base_motion.hpp"
#include "vigia/servo/gaze_controller.hpp"

namespace vigia::mission {

/// The attention of a pan-tilt-zoom camera: a planner says when to look and at what, a servo keeps
/// the landmark centred meanwhile. Both meet in the gaze order alone.
class PtzAttention : public Attention {
 public:
  /// @p camera: which the head turns. All references outlive the attention.
  PtzAttention(const MissionSetup& setup, const Camera& camera, std::uint64_t seed, EventLog& log);

  void follow(const Path& path) override;
  std::optional<GazeRequest> request() const override;
  void judge(const Observation& observation, const localization::UpdateResult& result,
             const Readings& readings) override;
  Demand plan(const Readings& readings, const Belief& belief, double station_m,
              LookId next_look) override;
  HeadRates steer(const Readings& readings, const Belief& belief, const BaseRates& base,
                  const std::vector<Observation>& observations,
                  const RecentMotion& motion) override;
  void cancel() override;
  std::optional<AttentionTick> tick(const Readings& readings,
                                    const std::vector<Observation>& observations,
                                    LookId look) const override;

 private:
  /// The look in force, or the last one.
  struct Look {
    LookId id = 0;
    TrackRequest request = TrackRequest::none;  ///< of the next capture
    std::optional<Stamp> acquired;              ///< since when its landmark is tracked
    int rejected_in_a_row = 0;
    bool fused = false;
  };

  void begin(const LookScheduler::Decision& decision, const Readings& readings,
             const Belief& belief);
  void drop(const std::string& reason, Stamp now);
  void note_failure(LandmarkId landmark, Stamp now);
  /// Landmarks at which the looks since the last fused one showed nothing.
  std::size_t different_failed() const;
  /// One landmark that fails again and again is missing; several are a sign of being elsewhere.
  bool contradicts_belief() const;
  /// A look has failed, the robot stands, and for a while there has been nothing else to look at.
  bool held_up(const Readings& readings, bool nothing_to_ask);
  /// The head points at where the landmark should be, and for longer than a known one takes it is
  /// not there.
  bool overdue(Stamp now);
  void record_limits(planner::LookDemand demand, bool stop, double sigma_m);
  void record_gaze(servo::GazeEvent event, LandmarkId landmark, Stamp now);
  const Observation* seen_in(const std::vector<Observation>& observations) const;
  std::optional<servo::GazeSighting> sighting_now(const Readings& readings, const Belief& belief,
                                                  const Observation& seen,
                                                  const RecentMotion& motion) const;

  const MissionSetup& setup_;
  CameraId camera_;
  EventLog& log_;
  RigOnGround on_ground_;
  double pause_s_;    ///< between two images beyond a tick, in which nothing new is seen
  double latency_s_;  ///< of the camera
  localization::LandmarkInformation information_;
  LookScheduler scheduler_;
  servo::GazeController gaze_;
  servo::BaseMotion base_motion_;
  double path_m_ = 0.0;  ///< length of the path
  Look look_;
  std::vector<LandmarkId> failed_;  ///< looks in a row that ended without anything fused
  std::optional<Stamp> held_up_since_;
  std::optional<Stamp> aimed_since_;  ///< at a landmark that is not seen there
  bool stopped_ = false;
  bool over_limit_1_ = false;
};

}  // namespace vigia::mission
