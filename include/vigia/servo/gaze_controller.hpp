#pragma once

#include <optional>
#include <string_view>

#include "vigia/core/actuation.hpp"
#include "vigia/core/belief.hpp"
#include "vigia/core/gaze.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/servo/pan_tilt_servo.hpp"
#include "vigia/servo/zoom_control.hpp"

namespace vigia::servo {

/// Of a camera that exposes in every tick and delivers at once; whoever has another one waits
/// longer.
struct GazeParams {
  PanTiltServoParams servo;
  ZoomControlParams zoom;
  double settle_deg = 1.0;     ///< slew ends within this of the aim …
  double settle_focal = 0.05;  ///< … and within this relative distance of the wanted focal length
  double lost_grace_s = 0.4;   ///< unseen this long, a tracked target is lost
  double acquire_s = 1.0;      ///< not found this long at the aim, search begins
  double search_s = 3.0;       ///< the search spiral ends after this
  double search_step_deg =
      15.0;  ///< pitch of the search spiral at the widest zoom; ∝ 1/focal length
  double search_radius_px = 10.0;  ///< searching, the zoom widens until the landmark is this small
  double aim_gain = 10.0;          ///< 1/s, of the slew's final approach
  double motion_horizon_s = 1.0;   ///< the base's motion is foreseen for at most this long
  double planned_min_px = 8.0;     ///< a planned zoom stays while the landmark is this large …
  double planned_max = 0.5;        ///< … and at most this part of half the image's smaller side
  /// σ of the head's angles, for the zoom at which the landmark is still inside the image.
  double look_angle = from_deg(0.3);
};

/// The tracker's answer to the last request, in pixels.
struct GazeSighting {
  Eigen::Vector2d uv;
  double radius_px = 0.0;  ///< of the whole landmark, as far as it is extent_radius() wide
};

struct GazeInput {
  Stamp now;
  HeadReading head;
  BaseRates base;  ///< by odometry, or better as BaseMotion expects them
  const Belief& belief;
  const LandmarkMap& landmarks;
  Intrinsics intrinsics;                 ///< calibrated at head.zoom_mm
  std::optional<GazeSighting> sighting;  ///< found in the frame of this tick
};

enum class GazeEvent { none, acquired, released, lost, expired };

std::string_view to_string(GazeEvent event);

struct GazeOutput {
  HeadRates command;
  TrackRequest request = TrackRequest::none;  ///< for the next frame
  GazeEvent event = GazeEvent::none;
};

/// Carries out the latest gaze order: slew – acquire – track – lost – search. Head and zoom are
/// sent to where the landmark will be when they arrive (Armingol §3.1). After dwell_s of tracking
/// the landmark is released and the gaze is idle; an order that passes its expiry without a feature
/// ends as expired.
///
/// - idle: head and zoom rest, or wait where rest_at() wants them; order() → slew.
/// - slew: head and zoom go where the belief has the landmark; both there → acquire.
/// - acquire: holds the aim, asks for the landmark; seen → track, after acquire_s → search.
/// - track: servo on the image, the zoom holds the size, or stays where the order has planned it as
///   long as the landmark is neither too small nor too large there; after dwell_s → released
///   (idle), unseen for lost_grace_s → lost.
/// - lost: holds the aim where it was last seen; seen → track, after acquire_s → search.
/// - search: spiral about the aim, the zoom widening; seen → track, after search_s → expired.
///
/// From acquire and lost the gaze returns to slew when the aim is farther than half the field from
/// the head (the pan's stop lies between, or the belief has jumped). In every state but track and
/// idle the order's expiry ends it. Found again after a loss, a landmark is tracked for the whole
/// dwell_s anew.
class GazeController {
 public:
  GazeController(HeadGeometry geometry, HeadLimits limits, ZoomCalibration zoom, GazeParams params,
                 const Ground& ground = {});

  /// Replaces the order in force; the state becomes slew. The released landmark is forgotten.
  void order(const GazeOrder& order);
  /// Drops the order; the head stops and the gaze is idle.
  void cancel();
  /// Where head and zoom wait while there is no order, as if to begin this one; nothing: they rest.
  void rest_at(const std::optional<GazeOrder>& waiting) { waiting_ = waiting; }
  /// One control tick. A sighting counts only when the last output requested one.
  GazeOutput step(const GazeInput& input);

  GazeState state() const { return state_; }
  const std::optional<GazeOrder>& current() const { return order_; }

 private:
  /// Where the head should be. Angles in rad, rates in rad/s.
  struct Aim {
    Eigen::Vector3d p_r;  ///< the landmark in the base frame
    HeadAngles now;       ///< its direction now
    HeadAngles forward;   ///< the rates that keep up with it
    HeadAngles
        intercept;  ///< driven to while running at forward, head and landmark meet on arrival
    double focal_px = 0.0;  ///< wanted on arrival
  };

  void carry_target(const GazeInput& input);
  Eigen::Vector3d landmark_in_base(const GazeInput& input, const Landmark& landmark) const;
  Eigen::Vector3d after_motion(const Eigen::Vector3d& p_r, const GazeInput& input,
                               double seconds) const;
  BaseTwist rolling(const GazeInput& input) const;
  Aim aim_for(const GazeInput& input, const Landmark& landmark) const;
  double wanted_focal(const GazeInput& input, const Landmark& landmark,
                      const Eigen::Vector3d& p_r) const;
  HeadAngles reachable(const HeadAngles& aim, const HeadAngles& from) const;
  double arrival_time(const GazeInput& input, const HeadAngles& aim, double focal_px) const;
  bool out_of_field(const GazeInput& input, const Aim& aim) const;

  /// The apparent radius to hold, px: the order's, or what is nearest to @p radius_px within the
  /// bounds of a planned zoom.
  double held_radius(double radius_px, const Intrinsics& intrinsics) const;
  /// The order that is carried out or waited for.
  const GazeOrder& active() const { return order_ ? *order_ : *waiting_; }
  GazeOutput rest(const GazeInput& input) const;
  GazeOutput slew(const GazeInput& input, const Aim& aim);
  GazeOutput hold(const GazeInput& input, const Aim& aim);
  GazeOutput search(const GazeInput& input, const Landmark& landmark, const Aim& aim);
  GazeOutput track(const GazeInput& input, const Landmark& landmark);
  GazeOutput miss(const GazeInput& input, const Aim& aim);

  HeadRates drive(const GazeInput& input, const Aim& aim, const HeadAngles& goal,
                  double focal_px) const;
  void enter(GazeState state, Stamp now);
  GazeOutput finish(GazeEvent event);

  HeadGeometry geometry_;
  HeadLimits limits_;
  ZoomCalibration zoom_;
  GazeParams params_;
  Ground ground_;
  PanTiltServo servo_;
  ZoomControl zoom_control_;
  GazeState state_ = GazeState::idle;
  std::optional<GazeOrder> order_;
  std::optional<Stamp> state_since_;  ///< unset until the first step of an order
  Stamp last_seen_;
  std::optional<Stamp> last_step_;
  std::optional<GazeOrder> waiting_;
  std::optional<Eigen::Vector3d> seen_at_r_;  ///< where this order's landmark was seen, base frame
};

}  // namespace vigia::servo
