#pragma once

#include <visp3/robot/vpRobotSimulator.h>

#include "vigia/sim/robot.hpp"

namespace vigia::sim {

/// The simulated robot as ViSP programs know one. Its end effector is the camera c, its reference
/// frame the world w. Articular velocities are (v, ω, pan rate, tilt rate) or (v, ω, v to the left,
/// pan rate, tilt rate), articular positions (x, y, θ, pan, tilt). A frame that has no meaning for
/// a call, a vector of the wrong length and a wrong state are vpRobotExceptions.
///
/// A class of its own, in a library of its own (vigia::sim_visp): libvisp_robot needs 240 shared
/// libraries, half a second of process start, which a mission has no use for.
class VispRobot final : public vpRobotSimulator, public Robot {
 public:
  /// As Robot.
  VispRobot(const RobotParams& params, const Pose2& start, double zoom_mm, std::uint64_t seed,
            const Ground& ground = {});
  VispRobot(const VispRobot&) = delete;
  VispRobot& operator=(const VispRobot&) = delete;
  ~VispRobot() override = default;

  void init() override;
  /// A column for each axis, twist of the camera in its own frame.
  void get_eJe(vpMatrix& eJe) override;
  /// The same with world axes.
  void get_fJe(vpMatrix& fJe) override;
  /// Change of the articular position since the last call, in articular coordinates.
  void getDisplacement(const vpRobot::vpControlFrameType frame, vpColVector& q) override;
  /// Articular, or the camera's pose wMc as (t, θu) for the camera, end-effector and reference
  /// frames.
  void getPosition(const vpRobot::vpControlFrameType frame, vpColVector& q) override;
  using vpRobot::getPosition;
  /// As place(). Articular only.
  void setPosition(const vpRobot::vpControlFrameType frame, const vpColVector& q) override;
  /// As command() with the zoom as it runs; the robot moves in advance(). Articular, or camera
  /// frame: the articular velocity whose camera twist is nearest.
  void setVelocity(const vpRobot::vpControlFrameType frame, const vpColVector& velocity) override;
  vpRobotStateType setRobotState(const vpRobot::vpRobotStateType state) override;

 private:
  vpColVector displacement_from_;
};

}  // namespace vigia::sim
