#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "vigia/core/gaze.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/mission/estimator_tick.hpp"
#include "vigia/mission/event.hpp"
#include "vigia/mission/setup.hpp"
#include "vigia/perception/eye.hpp"
#include "vigia/pilot/pilot.hpp"

namespace vigia::mission {

/// lost: the robot has looked around in vain, or what it sees fits several places.
enum class Outcome { arrived, collided, timeout, stuck, lost };

std::string_view to_string(Outcome outcome);

/// Wall-clock time of a tick's parts, milliseconds.
struct TickTiming {
  double step = 0.0;
  double render = 0.0;
  double track = 0.0;
  double localize = 0.0;
  double plan = 0.0;
  double servo = 0.0;
};

/// What a pan-tilt-zoom attention does in a tick.
struct AttentionTick {
  GazeState gaze = GazeState::idle;
  std::optional<GazeOrder> order;
  LookId look = 0;  ///< of what was observed, or the present one
  /// Distance of the feature from the principal point, px, when one was found while tracking.
  std::optional<double> centring_px;
  double tracked_s = 0.0;  ///< since the present target was acquired
  bool stopped_to_look = false;
};

/// One eye in a tick in which its camera delivered.
struct EyeTick {
  CameraId camera = 0;
  const perception::Eye* eye = nullptr;
  const imaging::Frame* frame = nullptr;
  bool observed = false;  ///< false: the frame belongs to an earlier look
};

/// One tick of a simulated mission. What it points to lives as long as the call.
struct Tick {
  EstimatorTick estimator;
  sim::RobotTruth truth;
  HeadReading head;
  BaseRates base_command;
  std::optional<AttentionTick> attention;  ///< nothing where no eye is directed
  double station_m = 0.0;
  std::vector<EyeTick> eyes;  ///< whose cameras have delivered
  /// Of the pilot's behaviours; nothing while a lost robot stands and looks around.
  std::optional<pilot::Activations> activations;
  TickTiming timing;
};

/// A mission that begins. What it refers to lives as long as the mission.
struct MissionStart {
  const MissionSetup& setup;
  std::uint64_t seed = 0;
  std::vector<const perception::Eye*> eyes;  ///< one for each camera of the robot
};

/// Is told what happens in a mission: the recorder, the score.
class Listener {
 public:
  virtual ~Listener() = default;
  virtual void on_start(const MissionStart& /*start*/) {}
  virtual void on_tick(const Tick& /*tick*/) {}
  virtual void on_event(const Event& /*event*/) {}
  virtual void on_finish(Outcome /*outcome*/, Stamp /*end*/) {}
};

}  // namespace vigia::mission
