#pragma once

#include <optional>

#include "vigia/core/actuation.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/random.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/sim/wheel_slip.hpp"

namespace vigia::sim {

/// Everything about a simulated robot that is fixed.
struct RobotParams {
  double radius_m = 0.3;
  double body_height_m = 0.0;  ///< of what its own cameras see of it; 0: nothing
  BaseLimits base;
  HeadGeometry head;
  HeadLimits head_limits;
  OdometryNoise odometry;
  SensorNoise sensor;
  std::optional<WheelStance> wheels = std::nullopt;  ///< of which nothing is said: by the hull

  /// Where the wheels touch the ground: as given, or on a circle of 0.7 of the hull's radius.
  WheelStance stance() const {
    return wheels.value_or(WheelStance{1.4 * radius_m, 1.4 * radius_m});
  }
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

/// Unicycle or omnidirectional base with a pan-tilt head and a motorised zoom: four velocity axes
/// (v, ω, pan, tilt), five (v, ω, v to the left, pan, tilt) when it is omnidirectional, and the
/// zoom beside them. Every axis is limited by itself in rate, acceleration and range; an axis that
/// meets its stop stands still there. The base moves on exact arcs, in steps of at most 5 ms while
/// it accelerates. A robot without a head has one that does not move. VispRobot is the same as a
/// vpRobotSimulator.
class Robot {
 public:
  /// Stands still at @p start, the head at rest at (0, 0) or the nearest angle in its range.
  Robot(const RobotParams& params, const Pose2& start, double zoom_mm, std::uint64_t seed,
        const Ground& ground = {});
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  ~Robot() = default;

  /// Range of the zoom motor, mm. Unlimited until it is set.
  void set_zoom_range(double min_mm, double max_mm);
  /// The camera that camera_pose() and camera_jacobian() mean. That of the head unless it is set.
  void set_camera(const CameraMount& mount) { camera_ = mount; }

  /// @name Disturbances
  /// None of them until they are set.
  /// @{
  void set_wheel_slip(const WheelSlip& slip) { slip_ = slip; }
  /// Play of the pan and tilt encoders, rad: a reading moves once its axis has turned so far on.
  void set_backlash(double width) { backlash_ = width; }
  /// rMr': how the head truly sits on the base. The jacobians, like everything the robot knows of
  /// itself, are those of a head mounted right.
  void set_mounting_error(const Eigen::Isometry3d& rMr) { mounting_ = rMr; }
  /// Puts the base elsewhere, standing still; neither odometry nor the head notices.
  void kidnap(const Pose2& pose);
  /// @}

  /// Puts base and head there at once, standing still; odometry and encoders count from there.
  /// @throws std::invalid_argument for angles beyond the head's range
  void place(const Pose2& pose, const HeadAngles& head);

  /// Asks for rates; they hold until the next call.
  void command(const BaseRates& base, const HeadRates& head);
  /// Moves by @p dt.
  void advance(Duration dt);
  /// Draws the errors that are constant during a look.
  void begin_look();

  const RobotTruth& truth() const { return truth_; }
  /// Where it stands in the world, upright on its wheels.
  Eigen::Isometry3d wMr() const { return ground_.place(truth_.pose); }
  /// What the wheels report of the motion since the last call: the chord (the true one unless the
  /// wheels slip) with an error of covariance control_covariance(). Backward motion has a negative
  /// trans.
  OdometryIncrement read_odometry();
  /// What the encoders say now (a fresh white part each call): true − look error − white, dragged
  /// by the backlash.
  HeadReading read_head();
  const RobotParams& params() const { return params_; }
  /// wMc, where the camera truly is.
  Eigen::Isometry3d camera_pose() const;
  /// The same @p s seconds from now (or before, negative) if every axis ran on at its present rate.
  Eigen::Isometry3d camera_pose_after(double s) const;
  /// The same of any camera that is mounted on the robot.
  Eigen::Isometry3d camera_pose(const CameraMount& mount) const;
  Eigen::Isometry3d camera_pose_after(const CameraMount& mount, double s) const;

  /// Twist (v, ω) of the camera in its own frame by a unit rate of each axis, 6×4 or 6×5.
  Eigen::Matrix<double, 6, Eigen::Dynamic> camera_jacobian() const;
  /// What command() asked for last.
  const HeadRates& head_command() const { return head_command_; }

 private:
  void step(double h);
  Eigen::Isometry3d camera_at(const CameraMount& mount, const Pose2& pose,
                              const HeadAngles& head) const;

  RobotParams params_;
  Ground ground_;
  CameraMount camera_;
  RobotTruth truth_;
  BaseRates base_command_;
  HeadRates head_command_;
  double zoom_min_mm_;
  double zoom_max_mm_;
  double turned_ = 0.0;  ///< since the last odometry reading, not wrapped
  Stamp odometry_stamp_;
  Pose2 odometry_pose_;  ///< at the last odometry reading, as the wheels count
  Pose2 wheel_pose_;     ///< where the base would be if the wheels were right
  HeadAngles encoder_;   ///< where the encoders are dragged to
  double backlash_ = 0.0;
  std::optional<WheelSlip> slip_;
  std::optional<Eigen::Isometry3d> mounting_;
  RandomStream odometry_random_;
  RandomStream look_random_;
  RandomStream reading_random_;
};

}  // namespace vigia::sim
