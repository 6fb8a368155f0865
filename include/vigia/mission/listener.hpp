#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/gaze.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/mission/setup.hpp"
#include "vigia/pilot/pilot.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"

namespace vigia::mission {

enum class Outcome { arrived, collided, timeout, stuck };

std::string_view to_string(Outcome outcome);

/// What one localizer made of a tick.
struct LocalizerTick {
  const Belief* belief = nullptr;
  std::optional<localization::UpdateResult> update;  ///< when an observation was offered
};

/// Wall-clock time of a tick's parts, milliseconds.
struct TickTiming {
  double step = 0.0;
  double render = 0.0;
  double track = 0.0;
  double localize = 0.0;
  double plan = 0.0;
  double servo = 0.0;
};

/// Everything that happened in one tick. References hold for the duration of the call.
struct Tick {
  Stamp now;
  const sim::RobotTruth& truth;
  /// The same when `frame` was exposed, and with it what was observed in it: late frames are older.
  const sim::RobotTruth& truth_at_exposure;
  const Pose2& true_pose_before;
  const OdometryIncrement& odometry;
  const HeadReading& head;
  BaseRates base_command;
  GazeState gaze = GazeState::idle;
  std::optional<GazeOrder> order;
  LookId look = 0;
  /// Status of the tracker, when it was asked.
  std::optional<tracking::FeatureStatus> feature;
  /// The observation handed to the localizers; before it is associated.
  const Observation* observation = nullptr;
  /// Distance of the feature from the principal point, px, when one was found while tracking.
  std::optional<double> centring_px;
  double tracked_s = 0.0;  ///< since the present target was acquired
  bool stopped_to_look = false;
  const std::vector<LocalizerTick>& localizers;  ///< in the order of MissionSetup::localizers
  std::size_t primary = 0;
  double station_m = 0.0;
  const imaging::Frame& frame;
  std::optional<Ellipse> predicted;  ///< expected image of the ordered landmark
  TickTiming timing;
  /// Of the pilot's behaviours; nothing while a lost robot stands and looks around.
  std::optional<pilot::Activations> activations;
};

/// A line of the story. Values are already text: numbers by shortest round trip.
struct Event {
  Stamp stamp;
  std::string kind;  ///< plan, look, acquired, released, lost, expired, rejected, stop, restart, …
  std::vector<std::pair<std::string, double>> numbers;
  std::vector<std::pair<std::string, std::string>> texts;
};

/// Watches a mission: the recorder, the evaluation.
class Listener {
 public:
  virtual ~Listener() = default;
  virtual void on_start(const MissionSetup& /*setup*/, std::uint64_t /*seed*/) {}
  virtual void on_tick(const Tick& /*tick*/) {}
  virtual void on_event(const Event& /*event*/) {}
  virtual void on_finish(Outcome /*outcome*/, Stamp /*end*/) {}
};

}  // namespace vigia::mission
