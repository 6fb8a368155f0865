#pragma once

#include <visp3/robot/vpRobotSimulator.h>

#include "vigia/core/actuation.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/random.hpp"
#include "vigia/core/sensor_noise.hpp"

namespace vigia::sim {

/// Everything about a simulated robot that is fixed.
struct RobotParams {
  double radius_m = 0.3;
  BaseLimits base;
  HeadGeometry head;
  HeadLimits head_limits;
  OdometryNoise odometry;
  SensorNoise sensor;
};

/// The robot's true state.
struct RobotTruth {
  Stamp stamp;
  Pose2 pose;
  BaseRates base;
  HeadAngles head;
  HeadAngles head_rates;
  double zoom_mm = 8.0;
  /// Errors of this look: true angle = encoder + error, true focal = exp(error) · calibrated.
  HeadAngles look_angle_error;
  double look_log_focal_error = 0.0;
};

/// Unicycle base with a pan-tilt head and a motorised zoom, as a ViSP simulated robot of four
/// velocity axes (v, ω, pan, tilt) and the zoom beside them. Every axis is limited by itself in
/// rate, acceleration and range.
class Robot : public vpRobotSimulator {
 public:
  Robot(const RobotParams& params, const Pose2& start, double zoom_mm, std::uint64_t seed);
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  /// Asks for rates; they hold until the next call.
  void command(const BaseRates& base, const HeadRates& head);
  /// Moves by @p dt.
  void advance(Duration dt);
  /// Draws the errors that are constant during a look.
  void begin_look();

  const RobotTruth& truth() const;
  /// What the wheels report of the motion since the last call.
  OdometryIncrement read_odometry();
  /// What the encoders say now (a fresh white part each call).
  HeadReading read_head();
  const RobotParams& params() const;

  // ViSP's interface. Articular = (v, ω, pan rate, tilt rate); camera frame = its velocity twist.
  void get_eJe(vpMatrix& eJe) override;
  void setVelocity(const vpRobot::vpControlFrameType frame, const vpColVector& velocity) override;
  void getPosition(const vpRobot::vpControlFrameType frame, vpColVector& q) override;
};

}  // namespace vigia::sim
