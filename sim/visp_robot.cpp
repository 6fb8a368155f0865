#include "vigia/sim/visp_robot.hpp"

#include <stdexcept>
#include <string>

#include <visp3/core/vpPoseVector.h>
#include <visp3/robot/vpRobotException.h>

namespace vigia::sim {
namespace {

using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

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

VispRobot::VispRobot(const RobotParams& params, const Pose2& start, double zoom_mm,
                     std::uint64_t seed, const Ground& ground)
    : Robot(params, start, zoom_mm, seed, ground) {
  VispRobot::init();
}

void VispRobot::init() {
  nDof = params().base.omnidirectional() ? 5 : 4;
  eJeAvailable = true;
  fJeAvailable = true;
  areJointLimitsAvailable = false;
  setMaxTranslationVelocity(params().base.speed);
  setMaxRotationVelocity(params().head_limits.rate);
  VispRobot::getPosition(ARTICULAR_FRAME, displacement_from_);
}

void VispRobot::get_eJe(vpMatrix& jacobian) {
  to_visp(camera_jacobian(), jacobian);
}

void VispRobot::get_fJe(vpMatrix& jacobian) {
  const Eigen::Matrix3d wRc = camera_pose().linear();
  Jacobian twists = camera_jacobian();
  twists.topRows<3>() = wRc * twists.topRows<3>();
  twists.bottomRows<3>() = wRc * twists.bottomRows<3>();
  to_visp(twists, jacobian);
}

void VispRobot::getDisplacement(const vpRobot::vpControlFrameType frame, vpColVector& q) {
  if (frame != ARTICULAR_FRAME) no_such_frame("getDisplacement");
  vpColVector now;
  getPosition(ARTICULAR_FRAME, now);
  q = now - displacement_from_;
  q[2] = wrap_angle(q[2]);
  displacement_from_ = now;
}

void VispRobot::getPosition(const vpRobot::vpControlFrameType frame, vpColVector& q) {
  if (frame == ARTICULAR_FRAME) {
    q.resize(5);
    q[0] = truth().pose.x;
    q[1] = truth().pose.y;
    q[2] = truth().pose.theta;
    q[3] = truth().head.pan;
    q[4] = truth().head.tilt;
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

void VispRobot::setPosition(const vpRobot::vpControlFrameType frame, const vpColVector& q) {
  if (frame != ARTICULAR_FRAME) no_such_frame("setPosition");
  require_length(q, 5, "an articular position");
  try {
    place({q[0], q[1], q[2]}, {q[3], q[4]});
  } catch (const std::invalid_argument& error) {
    throw vpRobotException(vpRobotException::positionOutOfRangeError, error.what());
  }
}

void VispRobot::setVelocity(const vpRobot::vpControlFrameType frame, const vpColVector& velocity) {
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
          {{rates[axes - 2], rates[axes - 1]}, head_command().zoom_mm_s});
}

vpRobot::vpRobotStateType VispRobot::setRobotState(const vpRobot::vpRobotStateType state) {
  if (state == STATE_STOP) command({}, {});
  return vpRobot::setRobotState(state);
}

}  // namespace vigia::sim
