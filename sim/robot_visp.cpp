// The part of Robot that ViSP asks for.
#include <algorithm>
#include <string>

#include <visp3/core/vpPoseVector.h>
#include <visp3/robot/vpRobotException.h>

#include "vigia/sim/robot.hpp"

namespace vigia::sim {
namespace {

/// Columns (v, ω, pan, tilt) of the camera's twist in its own frame.
Eigen::Matrix<double, 6, 4> camera_jacobian(const HeadGeometry& geometry, const HeadAngles& head) {
  Eigen::Matrix<double, 6, 4> jacobian;
  jacobian << camera_jacobian_base(geometry, head), camera_jacobian_head(geometry, head);
  return jacobian;
}

void to_visp(const Eigen::Matrix<double, 6, 4>& from, vpMatrix& to) {
  to.resize(6, 4);
  for (unsigned row = 0; row < 6; ++row)
    for (unsigned column = 0; column < 4; ++column) to[row][column] = from(row, column);
}

void require_length(const vpColVector& q, unsigned length, const char* what) {
  if (q.size() == length) return;
  throw vpRobotException(vpRobotException::dimensionError,
                         std::string(what) + " has " + std::to_string(q.size()) +
                             " entries where " + std::to_string(length) + " are needed");
}

[[noreturn]] void no_such_frame(const char* call) {
  throw vpRobotException(vpRobotException::badValue,
                         std::string(call) + " does not know this control frame");
}

}  // namespace

void Robot::init() {
  nDof = 4;
  eJeAvailable = true;
  fJeAvailable = true;
  areJointLimitsAvailable = false;
  setMaxTranslationVelocity(params_.base.speed);
  setMaxRotationVelocity(params_.head_limits.rate);
  Robot::getPosition(ARTICULAR_FRAME, displacement_from_);
}

void Robot::get_eJe(vpMatrix& jacobian) {
  to_visp(camera_jacobian(params_.head, truth_.head), jacobian);
}

void Robot::get_fJe(vpMatrix& jacobian) {
  const Eigen::Matrix3d wRc = camera_pose().linear();
  Eigen::Matrix<double, 6, 4> twists = camera_jacobian(params_.head, truth_.head);
  twists.topRows<3>() = wRc * twists.topRows<3>();
  twists.bottomRows<3>() = wRc * twists.bottomRows<3>();
  to_visp(twists, jacobian);
}

void Robot::getDisplacement(const vpRobot::vpControlFrameType frame, vpColVector& q) {
  if (frame != ARTICULAR_FRAME) no_such_frame("getDisplacement");
  vpColVector now;
  getPosition(ARTICULAR_FRAME, now);
  q = now - displacement_from_;
  q[2] = wrap_angle(q[2]);
  displacement_from_ = now;
}

void Robot::getPosition(const vpRobot::vpControlFrameType frame, vpColVector& q) {
  if (frame == ARTICULAR_FRAME) {
    q.resize(5);
    q[0] = truth_.pose.x;
    q[1] = truth_.pose.y;
    q[2] = truth_.pose.theta;
    q[3] = truth_.head.pan;
    q[4] = truth_.head.tilt;
    return;
  }
  if (frame == MIXT_FRAME) no_such_frame("getPosition");
  const Eigen::Isometry3d wMc = camera_pose();
  const Eigen::AngleAxisd turn(wMc.linear());
  q.resize(6);
  for (unsigned i = 0; i < 3; ++i) {
    q[i] = wMc.translation()[i];
    q[i + 3] = turn.angle() * turn.axis()[i];
  }
}

void Robot::setPosition(const vpRobot::vpControlFrameType frame, const vpColVector& q) {
  if (frame != ARTICULAR_FRAME) no_such_frame("setPosition");
  require_length(q, 5, "an articular position");
  const HeadLimits& limits = params_.head_limits;
  if (q[3] < limits.pan_min || q[3] > limits.pan_max || q[4] < limits.tilt_min ||
      q[4] > limits.tilt_max)
    throw vpRobotException(vpRobotException::positionOutOfRangeError,
                           "pan or tilt lies beyond the head's range");
  truth_.pose = {q[0], q[1], wrap_angle(q[2])};
  truth_.head = {q[3], q[4]};
  truth_.base = {};
  truth_.head_rates = {};
  command({}, {});
  encoder_ = truth_.head;
  odometry_pose_ = wheel_pose_ = truth_.pose;
  odometry_stamp_ = truth_.stamp;
  turned_ = 0.0;
}

void Robot::setVelocity(const vpRobot::vpControlFrameType frame, const vpColVector& velocity) {
  if (getRobotState() != STATE_VELOCITY_CONTROL)
    throw vpRobotException(vpRobotException::wrongStateError,
                           "setVelocity needs the state STATE_VELOCITY_CONTROL");
  Eigen::Vector4d rates;
  if (frame == ARTICULAR_FRAME) {
    require_length(velocity, 4, "an articular velocity");
    rates << velocity[0], velocity[1], velocity[2], velocity[3];
  } else if (frame == CAMERA_FRAME || frame == END_EFFECTOR_FRAME) {
    require_length(velocity, 6, "a velocity twist");
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> twist(velocity.data);
    rates =
        camera_jacobian(params_.head, truth_.head).completeOrthogonalDecomposition().solve(twist);
  } else {
    no_such_frame("setVelocity");
  }
  command({rates[0], rates[1]}, {{rates[2], rates[3]}, head_command_.zoom_mm_s});
}

vpRobot::vpRobotStateType Robot::setRobotState(const vpRobot::vpRobotStateType state) {
  if (state == STATE_STOP) command({}, {});
  return vpRobot::setRobotState(state);
}

}  // namespace vigia::sim
