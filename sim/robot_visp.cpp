// The part of Robot that ViSP asks for.
#include <algorithm>
#include <string>

#include <visp3/core/vpPoseVector.h>
#include <visp3/robot/vpRobotException.h>

#include "vigia/sim/robot.hpp"

namespace vigia::sim {
namespace {

using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

Eigen::Matrix<double, 6, 2> head_columns(const HeadGeometry& mount, const HeadAngles& head) {
  return camera_jacobian_head(mount, head);
}

Eigen::Matrix<double, 6, 2> head_columns(const FixedMount& /*mount*/, const HeadAngles& /*head*/) {
  return Eigen::Matrix<double, 6, 2>::Zero();
}

void to_visp(const Jacobian& from, vpMatrix& to) {
  const auto columns = static_cast<unsigned>(from.cols());
  to.resize(6, columns);
  for (unsigned row = 0; row < 6; ++row)
    for (unsigned column = 0; column < columns; ++column) to[row][column] = from(row, column);
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

/// The camera's twist in its own frame by every axis.
Eigen::Matrix<double, 6, Eigen::Dynamic> Robot::camera_jacobian() const {
  const Eigen::Isometry3d rMc = mounted_camera(camera_, truth_.head);
  const Eigen::Matrix<double, 6, 2> head =
      std::visit([this](const auto& mount) { return head_columns(mount, truth_.head); }, camera_);
  Jacobian jacobian(6, nDof);
  if (params_.base.omnidirectional())
    jacobian << camera_jacobian_base(rMc), camera_twist_sideways(rMc), head;
  else
    jacobian << camera_jacobian_base(rMc), head;
  return jacobian;
}

void Robot::init() {
  nDof = params_.base.omnidirectional() ? 5 : 4;
  eJeAvailable = true;
  fJeAvailable = true;
  areJointLimitsAvailable = false;
  setMaxTranslationVelocity(params_.base.speed);
  setMaxRotationVelocity(params_.head_limits.rate);
  Robot::getPosition(ARTICULAR_FRAME, displacement_from_);
}

void Robot::get_eJe(vpMatrix& jacobian) {
  to_visp(camera_jacobian(), jacobian);
}

void Robot::get_fJe(vpMatrix& jacobian) {
  const Eigen::Matrix3d wRc = camera_pose().linear();
  Jacobian twists = camera_jacobian();
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
  const auto axes = static_cast<unsigned>(nDof);
  Eigen::VectorXd rates(axes);
  if (frame == ARTICULAR_FRAME) {
    require_length(velocity, axes, "an articular velocity");
    rates = Eigen::Map<const Eigen::VectorXd>(velocity.data, axes);
  } else if (frame == CAMERA_FRAME || frame == END_EFFECTOR_FRAME) {
    require_length(velocity, 6, "a velocity twist");
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> twist(velocity.data);
    rates = camera_jacobian().completeOrthogonalDecomposition().solve(twist);
  } else {
    no_such_frame("setVelocity");
  }
  const double side = axes == 5 ? rates[2] : 0.0;
  command({rates[0], rates[1], side},
          {{rates[axes - 2], rates[axes - 1]}, head_command_.zoom_mm_s});
}

vpRobot::vpRobotStateType Robot::setRobotState(const vpRobot::vpRobotStateType state) {
  if (state == STATE_STOP) command({}, {});
  return vpRobot::setRobotState(state);
}

}  // namespace vigia::sim
