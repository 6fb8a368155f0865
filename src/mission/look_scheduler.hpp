#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vigia/core/gaze.hpp"
#include "vigia/mission/setup.hpp"
#include "vigia/planner/look_policy.hpp"

namespace vigia::mission {

/// Decides when to look and at what: trigger, policy, and the landmarks that failed lately.
class LookScheduler {
 public:
  LookScheduler(const MissionSetup& setup, const InformationModel& information, std::uint64_t seed);

  /// What is demanded now; the planner's slow rate is kept inside.
  planner::LookDemand demand(Stamp now, const Belief& belief, double travelled_m,
                             double remaining_m);

  /// The robot follows this path from now on: to be told before anything is chosen. It must outlive
  /// the scheduler's use of it.
  void follow(const Path& path);
  /// The base as the next look finds it.
  struct Going {
    double station_m = 0.0;
    double speed_mps = 0.0;
    bool standing = false;  ///< stopped in order to look
  };
  /// A gaze order and why it was given.
  struct Decision {
    GazeOrder order;
    std::optional<double> suitability;
    std::string reason;
  };
  /// The next gaze order, whose look has no number yet, or nothing when no landmark will do.
  std::optional<Decision> choose(Stamp now, const Belief& belief, const HeadReading& head,
                                 const Going& going);

  /// What a look now would be, for head and zoom to wait there; nothing when the policy does not
  /// prepare. Takes no number and is asked at the planner's slow rate.
  std::optional<GazeOrder> prepare(Stamp now, const Belief& belief, const HeadReading& head,
                                   const Going& going);

  /// The landmark could not be acquired or held: it is left out for a while, which doubles with
  /// each failure until it is seen again.
  void failed(Stamp now, LandmarkId landmark);
  /// An observation of the landmark was fused.
  void fused(double travelled_m, LandmarkId landmark);

 private:
  const MissionSetup& setup_;
  const InformationModel& information_;
  planner::Visibility visibility_;
  planner::HeadModel head_model_;
  const Path* path_ = nullptr;
  std::unique_ptr<planner::LookPolicy> policy_;
  planner::LookTrigger trigger_;
  planner::LookDemand last_ = planner::LookDemand::none;
  std::optional<Stamp> asked_;
  std::optional<Stamp> prepared_;
  std::optional<GazeOrder> waiting_;
  struct Failure {
    Stamp until;
    int count = 0;
  };
  std::map<LandmarkId, Failure> failures_;
};

}  // namespace vigia::mission
