#include "vigia/core/head.hpp"

#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia {
namespace {

/// rRh: pan about the base's z, then tilt (positive up) about the head's −y.
Eigen::Matrix3d base_from_head(const HeadGeometry& geometry, const HeadAngles& angles) {
  const Eigen::Vector2d pan = unit_vector(geometry.mount_yaw + angles.pan);
  const Eigen::Vector2d tilt = unit_vector(angles.tilt);
  Eigen::Matrix3d rRh;
  rRh << pan.x() * tilt.x(), -pan.y(), -pan.x() * tilt.y(),  //
      pan.y() * tilt.x(), pan.x(), -pan.y() * tilt.y(),      //
      tilt.y(), 0.0, tilt.x();
  return rRh;
}

/// Twist in frame c of a camera at p_r that turns about the axis (point, direction) of frame r.
Eigen::Matrix<double, 6, 1> twist_about(const Eigen::Isometry3d& rMc,
                                        const Eigen::Vector3d& point_r,
                                        const Eigen::Vector3d& axis_r) {
  const Eigen::Matrix3d cRr = rMc.linear().transpose();
  Eigen::Matrix<double, 6, 1> twist;
  twist << cRr * axis_r.cross(rMc.translation() - point_r), cRr * axis_r;
  return twist;
}

}  // namespace

Eigen::Matrix3d head_from_camera() {
  Eigen::Matrix3d hRc;
  hRc << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return hRc;
}

Eigen::Isometry3d camera_in_base(const HeadGeometry& geometry, const HeadAngles& angles) {
  const Eigen::Matrix3d rRh = base_from_head(geometry, angles);
  Eigen::Isometry3d rMc = Eigen::Isometry3d::Identity();
  rMc.linear() = rRh * head_from_camera();
  rMc.translation() = geometry.mount_r + rRh * geometry.camera_offset_h;
  return rMc;
}

Eigen::Matrix<double, 6, 2> camera_jacobian_head(const HeadGeometry& geometry,
                                                 const HeadAngles& angles) {
  return camera_jacobian_head(geometry, angles, camera_in_base(geometry, angles));
}

Eigen::Matrix<double, 6, 2> camera_jacobian_head(const HeadGeometry& geometry,
                                                 const HeadAngles& angles,
                                                 const Eigen::Isometry3d& rMc) {
  const Eigen::Vector2d ahead = unit_vector(geometry.mount_yaw + angles.pan);
  const Eigen::Vector3d tilt_axis_r(ahead.y(), -ahead.x(), 0.0);
  Eigen::Matrix<double, 6, 2> jacobian;
  jacobian << twist_about(rMc, geometry.mount_r, Eigen::Vector3d::UnitZ()),
      twist_about(rMc, geometry.mount_r, tilt_axis_r);
  return jacobian;
}

Eigen::Matrix<double, 6, 1> camera_twist_sideways(const Eigen::Isometry3d& rMc) {
  Eigen::Matrix<double, 6, 1> twist;
  twist << rMc.linear().transpose() * Eigen::Vector3d::UnitY(), Eigen::Vector3d::Zero();
  return twist;
}

Eigen::Matrix<double, 6, 2> camera_jacobian_base(const HeadGeometry& geometry,
                                                 const HeadAngles& angles) {
  return camera_jacobian_base(camera_in_base(geometry, angles));
}

Eigen::Matrix<double, 6, 2> camera_jacobian_base(const Eigen::Isometry3d& rMc) {
  Eigen::Matrix<double, 6, 2> jacobian;
  jacobian.col(0) << rMc.linear().transpose() * Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero();
  jacobian.col(1) = twist_about(rMc, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  return jacobian;
}

HeadAngles aim_at(const HeadGeometry& geometry, const Eigen::Vector3d& p_r) {
  HeadAngles angles;
  for (int i = 0; i < 3; ++i) {
    // The camera's lateral offset, turned with the head, displaces the point that the head aims at.
    const Eigen::Vector3d offset_h(0.0, geometry.camera_offset_h.y(), geometry.camera_offset_h.z());
    const Eigen::Vector3d d = p_r - geometry.mount_r - base_from_head(geometry, angles) * offset_h;
    angles.pan = wrap_angle(std::atan2(d.y(), d.x()) - geometry.mount_yaw);
    angles.tilt = std::atan2(d.z(), d.head<2>().norm());
  }
  return angles;
}

}  // namespace vigia
