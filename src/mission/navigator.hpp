#pragma once

#include "blockages.hpp"
#include "event_log.hpp"

#include <optional>
#include <string>
#include <vector>

#include "vigia/pilot/pilot.hpp"

namespace vigia::mission {

/// What the base is asked for, and what became of the route.
struct NavigationStep {
  BaseRates rates;
  pilot::Activations activations;
  bool replanned = false;  ///< path() is another
  bool gave_up = false;    ///< the path stays blocked and there is no way round
};

/// Drives the mission's route: the pilot follows a path, and another is planned where it stays
/// blocked or the robot turns out to be elsewhere.
class Navigator {
 public:
  /// @p setup and @p log outlive the navigator.
  Navigator(const MissionSetup& setup, EventLog& log);

  NavigationStep step(const pilot::PilotInput& input);
  /// A route from here to the waypoints that lie ahead, round @p others. Whether there is one.
  bool replan(const Pose2& from, const std::string& reason,
              const std::vector<RoundObstacle>& others = {});

  bool arrived() const { return pilot_.arrived(); }
  double station() const { return pilot_.station(); }
  const Path& path() const { return pilot_.path(); }

 private:
  void record(const pilot::PilotOutput& output);
  /// Where on the path that the pilot follows the points to pass lie.
  void place_vias();
  /// Says which points to pass lie behind and were not passed.
  void watch_vias(const Pose2& here);
  void go_round(const pilot::PilotInput& input, const pilot::PilotOutput& output,
                NavigationStep& step);
  /// The pilot does not go into a passage: another way, or none.
  void go_elsewhere(const pilot::PilotInput& input, const pilot::PassageRefusal& refused,
                    NavigationStep& step);

  const MissionSetup& setup_;
  EventLog& log_;
  pilot::Pilot pilot_;
  Blockages blockages_;
  std::vector<Eigen::Vector2d> waypoints_;  ///< of the path that the pilot follows
  pilot::PilotStatus status_ = pilot::PilotStatus::driving;
  bool evading_ = false;
  int realigned_ = 0;  ///< times that a passage was driven at anew
  /// A point to pass that is not done with.
  struct Via {
    Eigen::Vector2d at;
    double nearest_m;
    std::optional<double> station_m;  ///< on the path, if that still leads there
  };
  std::vector<Via> vias_;
};

}  // namespace vigia::mission
