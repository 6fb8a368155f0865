#pragma once

#include <optional>

#include "vigia/core/actuation.hpp"
#include "vigia/core/belief.hpp"
#include "vigia/core/gaze.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/servo/pan_tilt_servo.hpp"
#include "vigia/servo/zoom_control.hpp"

namespace vigia::servo {

struct GazeParams {
  PanTiltServoParams servo;
  ZoomControlParams zoom;
  double settle_deg = 1.0;      ///< slew ends within this of the aim …
  double settle_focal = 0.05;   ///< … and within this relative distance of the wanted focal length
  double lost_grace_s = 0.4;    ///< unseen this long, a tracked target is lost
  double acquire_s = 1.0;       ///< not found this long at the aim, search begins
  double search_s = 3.0;        ///< the search spiral ends after this
  double search_step_deg = 3.0; ///< pitch of the search spiral at the widest zoom's field, scaled
  double aim_gain = 6.0;        ///< 1/s, of the slew's final approach
};

/// What the tracker is asked to do with the next frame.
enum class TrackRequest { none, acquire, track };

/// The tracker's answer to the last request, in pixels.
struct GazeSighting {
  Eigen::Vector2d uv;
  double radius_px = 0.0;
};

struct GazeInput {
  Stamp now;
  HeadReading head;
  BaseRates base;                         ///< by odometry
  const Belief& belief;
  const LandmarkMap& landmarks;
  Intrinsics intrinsics;                  ///< calibrated at head.zoom_mm
  std::optional<GazeSighting> sighting;   ///< found in the frame of this tick
};

enum class GazeEvent { none, acquired, released, lost, expired };

std::string_view to_string(GazeEvent event);

struct GazeOutput {
  HeadRates command;
  TrackRequest request = TrackRequest::none;  ///< for the next frame
  GazeEvent event = GazeEvent::none;
};

/// Carries out the latest gaze order: slew – acquire – track – lost – search. Head and zoom are sent
/// to where the landmark will be when they arrive. After dwell_s of tracking the landmark is
/// released and the gaze is idle; an order that passes its expiry without a feature ends as expired.
class GazeController {
 public:
  GazeController(HeadGeometry geometry, HeadLimits limits, ZoomCalibration zoom, GazeParams params);

  /// Replaces the order in force; the state becomes slew. The released landmark is forgotten.
  void order(const GazeOrder& order);
  /// Drops the order; the head stops and the gaze is idle.
  void cancel();
  GazeOutput step(const GazeInput& input);

  GazeState state() const { return state_; }
  const std::optional<GazeOrder>& current() const { return order_; }

 private:
  HeadGeometry geometry_;
  HeadLimits limits_;
  ZoomCalibration zoom_;
  GazeParams params_;
  GazeState state_ = GazeState::idle;
  std::optional<GazeOrder> order_;
};

}  // namespace vigia::servo
