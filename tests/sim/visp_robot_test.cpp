#include "vigia/sim/visp_robot.hpp"

#include "sim/exact_robot.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <visp3/robot/vpRobotException.h>

namespace vigia::sim {
namespace {

using testing::exact_robot;

TEST(VispRobot, ItsJacobianIsTheDerivativeOfTheTrueCameraPose) {
  RobotParams params = exact_robot();
  params.head.mount_r = {0.15, 0.02, 1.2};
  params.head.mount_yaw = 0.2;
  params.head.camera_offset_h = {0.05, 0.01, 0.03};
  const double h = 1e-5;
  for (int axis = 0; axis < 4; ++axis) {
    const auto camera_after = [&](double q) {
      // Base: a short move along x or a turn on the spot, from a pose that is not the origin.
      VispRobot robot(params, {1.0, -2.0, 0.7}, 8.0, 1);
      vpColVector position;
      robot.getPosition(vpRobot::ARTICULAR_FRAME, position);
      position[3] = 0.6 + (axis == 2 ? q : 0.0);
      position[4] = -0.3 + (axis == 3 ? q : 0.0);
      if (axis == 0) {
        position[0] += q * std::cos(0.7);
        position[1] += q * std::sin(0.7);
      }
      if (axis == 1) position[2] += q;
      robot.setPosition(vpRobot::ARTICULAR_FRAME, position);
      return robot.camera_pose();
    };
    const Eigen::Isometry3d wMc = camera_after(0.0);
    const Eigen::Isometry3d change = camera_after(-h).inverse() * camera_after(h);
    const Eigen::AngleAxisd turn(change.linear());
    VispRobot robot(params, {1.0, -2.0, 0.7}, 8.0, 1);
    vpColVector position;
    robot.getPosition(vpRobot::ARTICULAR_FRAME, position);
    position[3] = 0.6;
    position[4] = -0.3;
    robot.setPosition(vpRobot::ARTICULAR_FRAME, position);
    vpMatrix eJe;
    vpMatrix fJe;
    robot.get_eJe(eJe);
    robot.get_fJe(fJe);
    const Eigen::Vector3d velocity_w =
        (camera_after(h).translation() - camera_after(-h).translation()) / (2.0 * h);
    for (unsigned i = 0; i < 3; ++i) {
      const auto column = static_cast<unsigned>(axis);
      EXPECT_NEAR(eJe[i][column], (wMc.linear().transpose() * velocity_w)(i), 1e-8);
      EXPECT_NEAR(eJe[i + 3][column], turn.angle() * turn.axis()(i) / (2.0 * h), 1e-6);
      EXPECT_NEAR(fJe[i][column], velocity_w(i), 1e-8);
    }
  }
}

TEST(VispRobot, MovesThroughThePointerThatVispPrograms) {
  VispRobot robot(exact_robot(), {}, 8.0, 1);
  vpRobot& visp = robot;
  visp.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  vpColVector rates(4, 0.0);
  rates[0] = 0.2;
  rates[2] = 0.5;
  visp.setVelocity(vpRobot::ARTICULAR_FRAME, rates);
  robot.advance(Duration::from_seconds(2.0));
  vpColVector position;
  visp.getPosition(vpRobot::ARTICULAR_FRAME, position);
  EXPECT_GT(position[0], 0.3);
  EXPECT_GT(position[3], 0.9);
  vpColVector displacement;
  visp.getDisplacement(vpRobot::ARTICULAR_FRAME, displacement);
  EXPECT_NEAR(displacement[0], position[0], 1e-12);
  visp.setRobotState(vpRobot::STATE_STOP);
  robot.advance(Duration::from_seconds(2.0));
  EXPECT_EQ(robot.truth().base.v, 0.0);
}

TEST(VispRobot, ACameraTwistWithinReachIsReached) {
  VispRobot robot(exact_robot(), {}, 8.0, 1);
  robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  vpMatrix eJe;
  robot.get_eJe(eJe);
  vpColVector rates(4, 0.0);
  rates[0] = 0.1;
  rates[3] = 0.2;
  robot.setVelocity(vpRobot::CAMERA_FRAME, eJe * rates);
  robot.advance(Duration::from_seconds(1.0));
  EXPECT_NEAR(robot.truth().base.v, 0.1, 1e-9);
  EXPECT_NEAR(robot.truth().head_rates.tilt, 0.2, 1e-9);
}

TEST(VispRobot, RefusesAVelocityInTheWrongStateOrOfTheWrongLength) {
  VispRobot robot(exact_robot(), {}, 8.0, 1);
  EXPECT_THROW(robot.setVelocity(vpRobot::ARTICULAR_FRAME, vpColVector(4, 0.0)), vpRobotException);
  robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  EXPECT_THROW(robot.setVelocity(vpRobot::ARTICULAR_FRAME, vpColVector(3, 0.0)), vpRobotException);
  EXPECT_THROW(robot.setVelocity(vpRobot::MIXT_FRAME, vpColVector(6, 0.0)), vpRobotException);
}

TEST(VispRobot, HasFiveAxesWhenItIsOmnidirectional) {
  RobotParams params = exact_robot();
  params.base.side_speed = 0.25;
  params.base.side_acceleration = 0.4;
  VispRobot robot(params, {0.5, 0.2, 0.4}, 8.0, 1);
  vpMatrix eJe;
  robot.get_eJe(eJe);
  ASSERT_EQ(eJe.getCols(), 5U);
  robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  robot.setVelocity(vpRobot::ARTICULAR_FRAME,
                    vpColVector(std::vector<double>{0.1, 0.2, 0.15, 0.3, 0.1}));
  robot.advance(Duration::from_seconds(2.0));
  EXPECT_DOUBLE_EQ(robot.truth().base.vy, 0.15);
  EXPECT_DOUBLE_EQ(robot.truth().head_rates.pan, 0.3);
  // The camera's twist is the Jacobian's.
  robot.get_eJe(eJe);
  vpColVector rates(std::vector<double>{0.1, 0.2, 0.15, 0.3, 0.1});
  const vpColVector twist = eJe * rates;
  constexpr double kStep = 1e-5;
  const Eigen::Isometry3d moved =
      robot.camera_pose_after(-kStep).inverse() * robot.camera_pose_after(kStep);
  for (unsigned i = 0; i < 3; ++i)
    EXPECT_NEAR(twist[i], moved.translation()(i) / (2.0 * kStep), 1e-6);
}

}  // namespace
}  // namespace vigia::sim
