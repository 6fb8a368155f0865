#include "vigia/localization/spatial_pose.hpp"

#include "camera_twists.hpp"
#include "space_geometry.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"

namespace vigia::localization {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// ∂θ/∂δφ of θ = atan2(f_y, f_x), f the robot's front in world axes.
Eigen::RowVector3d heading_by_turn(const Eigen::Vector3d& f) {
  const double flat = f.head<2>().squaredNorm();
  const Eigen::RowVector3d dtheta_df(-f.y() / flat, f.x() / flat, 0.0);
  return -dtheta_df * skew(f);  // df = δφ × f
}

PlanarEstimate seen_from_above_floor(const SpatialPose& pose) {
  const Eigen::Vector3d front = pose.wMr.linear().col(0);
  PlanarEstimate planar;
  planar.pose = {pose.wMr.translation().x(), pose.wMr.translation().y(),
                 std::atan2(front.y(), front.x())};
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J.topLeftCorner<2, 2>().setIdentity();
  J.block<1, 3>(2, 3) = heading_by_turn(front);
  planar.covariance = J * pose.covariance * J.transpose();
  return planar;
}

}  // namespace

SpatialPose robot_in_space(const Landmark& landmark, const FittedPose& fit, const Shot& shot,
                           const RigOnGround& on_ground, const SensorNoise& noise) {
  const Camera& camera = on_ground.rig.at(shot.camera);
  const Eigen::Isometry3d rMc = camera.rMc(shot.head);
  const Eigen::Isometry3d wMc = landmark.wMl * fit.cMl.inverse();
  SpatialPose pose;
  pose.wMr = wMc * rMc.inverse();

  // A move (v, ω) of the landmark in the camera is one of the camera in the world: it turns by −ω
  // and shifts by −v − (−ω) × t, all in camera axes. The base follows rigidly.
  const Eigen::Vector3d camera_to_base =
      wMc.linear().transpose() * (pose.wMr.translation() - wMc.translation());
  Matrix6 dbase_dfit = Matrix6::Zero();  // in camera axes
  dbase_dfit.topLeftCorner<3, 3>() = -Eigen::Matrix3d::Identity();
  dbase_dfit.topRightCorner<3, 3>() = skew(camera_to_base) - skew(fit.cMl.translation());
  dbase_dfit.bottomRightCorner<3, 3>() = -Eigen::Matrix3d::Identity();
  // The camera's twist in the base by pan and tilt moves the base the other way, about the camera.
  const Eigen::Matrix<double, 6, 2> twist = head_twists(camera, shot.head, rMc);
  Eigen::Matrix<double, 6, 2> dbase_dhead;
  dbase_dhead << skew(camera_to_base) * twist.bottomRows<3>() - twist.topRows<3>(),
      -twist.bottomRows<3>();

  const double angle_variance =
      noise.look_angle * noise.look_angle + noise.reading_angle * noise.reading_angle;
  const Matrix6 of_fit = fit.covariance + noise.look_focal * noise.look_focal *
                                              fit.dpose_dlog_focal *
                                              fit.dpose_dlog_focal.transpose();
  const Matrix6 in_camera = dbase_dfit * of_fit * dbase_dfit.transpose() +
                            angle_variance * dbase_dhead * dbase_dhead.transpose();
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = wMc.linear();
  turn.bottomRightCorner<3, 3>() = wMc.linear();
  pose.covariance = turn * in_camera * turn.transpose();
  return pose;
}

FloorAttitude floor_attitude(const SpatialPose& pose) {
  const Eigen::Vector3d front = pose.wMr.linear().col(0);
  const Eigen::Vector3d left = pose.wMr.linear().col(1);
  FloorAttitude floor;
  floor.z_m = pose.wMr.translation().z();
  floor.pitch = std::asin(std::min(1.0, std::max(-1.0, front.z())));
  floor.roll = std::asin(std::min(1.0, std::max(-1.0, left.z())));
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J(0, 2) = 1.0;
  J.block<1, 3>(1, 3) = -skew(front).row(2) / std::cos(floor.pitch);
  J.block<1, 3>(2, 3) = -skew(left).row(2) / std::cos(floor.roll);
  floor.covariance = J * pose.covariance * J.transpose();
  return floor;
}

PlanarEstimate seen_from_above(const SpatialPose& pose, const Ground& ground) {
  if (ground.flat()) return seen_from_above_floor(pose);
  const Eigen::Isometry3d gMw = ground.frame_under(pose.wMr.translation()).inverse(Eigen::Isometry);
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = gMw.linear();
  turn.bottomRightCorner<3, 3>() = gMw.linear();
  return seen_from_above_floor({gMw * pose.wMr, turn * pose.covariance * turn.transpose()});
}

SpatialPose moved_by(const SpatialPose& pose, const OdometryIncrement& u,
                     const OdometryNoise& noise, const Ground& ground) {
  Eigen::Isometry3d step = to_isometry(move(Pose2{}, u));
  if (!ground.flat()) {
    const Pose2 from = seen_from_above(pose, ground).pose;
    step = ground.place(from).inverse(Eigen::Isometry) * ground.place(move(from, u));
  }
  SpatialPose result;
  result.wMr = pose.wMr * step;
  Matrix6 F = Matrix6::Identity();
  F.topRightCorner<3, 3>() = -skew(pose.wMr.linear() * step.translation());
  const Eigen::Matrix3d G = move_jacobian_control(Pose2{}, u);
  const Eigen::Matrix3d Q = G * control_covariance(u, noise) * G.transpose();
  Eigen::Matrix<double, 6, 3> to_world = Eigen::Matrix<double, 6, 3>::Zero();
  to_world.topLeftCorner<3, 2>() = pose.wMr.linear().leftCols<2>();
  to_world.bottomRightCorner<3, 1>() = pose.wMr.linear().col(2);
  result.covariance = F * pose.covariance * F.transpose() + to_world * Q * to_world.transpose();
  return result;
}

}  // namespace vigia::localization
