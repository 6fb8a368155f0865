#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/rig.hpp"

namespace vigia::localization {

/// A camera of a robot at a pose.
struct PlacedCamera {
  const Camera* camera = nullptr;
  HeadAngles head;
  Eigen::Isometry3d rMc = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d wMc = Eigen::Isometry3d::Identity();

  PlacedCamera(const RigOnGround& on_ground, CameraId id, const HeadAngles& at, const Pose2& pose)
      : camera(&on_ground.rig.at(id)),
        head(at),
        rMc(camera->rMc(at)),
        wMc(on_ground.ground.place(pose) * rMc) {}
};

/// Columns: the camera's twist (v, ω) in its own frame per pan and tilt. A fixed camera has none.
inline Eigen::Matrix<double, 6, 2> head_twists(const Camera& camera, const HeadAngles& head,
                                               const Eigen::Isometry3d& rMc) {
  const auto* mount = std::get_if<HeadGeometry>(&camera.mount);
  if (mount == nullptr) return Eigen::Matrix<double, 6, 2>::Zero();
  return camera_jacobian_head(*mount, head, rMc);
}

/// Columns: the camera's twist (v, ω) in its own frame per x, y, θ.
inline Eigen::Matrix<double, 6, 3> base_twists(const RigOnGround& on_ground,
                                               const Eigen::Isometry3d& rMc, const Pose2& pose,
                                               const Eigen::Isometry3d& wMc) {
  Eigen::Matrix<double, 6, 3> twists = Eigen::Matrix<double, 6, 3>::Zero();
  if (on_ground.ground.flat()) {
    twists.topLeftCorner<3, 2>() = wMc.linear().transpose().leftCols<2>();
    const Eigen::Matrix3d cRr = rMc.linear().transpose();
    twists.col(2) << cRr * Eigen::Vector3d::UnitZ().cross(rMc.translation()),
        cRr * Eigen::Vector3d::UnitZ();
    return twists;
  }
  const Eigen::Matrix<double, 6, 3> steps = on_ground.ground.dplace_dpose(pose);
  const Eigen::Matrix3d cRw = wMc.linear().transpose();
  const Eigen::Vector3d arm_w = wMc.translation() - on_ground.ground.place(pose).translation();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Vector3d turn_w = steps.col(i).tail<3>();
    twists.col(i) << cRw * (steps.col(i).head<3>() + turn_w.cross(arm_w)), cRw * turn_w;
  }
  return twists;
}

/// Columns: the camera's twist (v, ω) in its own frame per x, y, θ, pan and tilt.
inline Eigen::Matrix<double, 6, 5> camera_twists(const RigOnGround& on_ground,
                                                 const PlacedCamera& placed, const Pose2& pose) {
  Eigen::Matrix<double, 6, 5> twists;
  twists << base_twists(on_ground, placed.rMc, pose, placed.wMc),
      head_twists(*placed.camera, placed.head, placed.rMc);
  return twists;
}

}  // namespace vigia::localization
