#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vigia {

/// Where the pan-tilt head sits on the base and the camera on the head. Frame h (head): x along the
/// optical axis at camera_offset zero, y left, z up, turned by pan (counter-clockwise seen from
/// above) and tilt (positive up). Frame c: z forward, x right, y down.
struct HeadGeometry {
  Eigen::Vector3d mount_r{0.15, 0.0, 1.0};  ///< crossing of the two axes in the base frame, m
  double mount_yaw = 0.0;                   ///< direction of pan = 0 in the base frame, rad
  Eigen::Vector3d camera_offset_h{0.0, 0.0, 0.0};  ///< optical centre in the head frame, m
};

/// Pan and tilt, radians.
struct HeadAngles {
  double pan = 0.0;
  double tilt = 0.0;
};

/// hRc, the fixed rotation from camera axes to head axes (camera z = head x).
Eigen::Matrix3d head_from_camera();

/// rMc, the camera in the base frame.
Eigen::Isometry3d camera_in_base(const HeadGeometry& geometry, const HeadAngles& angles);

/// Columns ∂(v, ω)/∂(pan rate, tilt rate): velocity twist of the camera in its own frame c.
Eigen::Matrix<double, 6, 2> camera_jacobian_head(const HeadGeometry& geometry,
                                                 const HeadAngles& angles);
/// The same where rMc, camera_in_base() at these angles, is at hand.
Eigen::Matrix<double, 6, 2> camera_jacobian_head(const HeadGeometry& geometry,
                                                 const HeadAngles& angles,
                                                 const Eigen::Isometry3d& rMc);

/// Columns ∂(v, ω)/∂(base speed, base turn rate): velocity twist of the camera in its own frame c.
Eigen::Matrix<double, 6, 2> camera_jacobian_base(const HeadGeometry& geometry,
                                                 const HeadAngles& angles);

/// Twist (v, ω) of a camera at rMc, in its own frame c, while the base goes to its left at 1 m/s.
Eigen::Matrix<double, 6, 1> camera_twist_sideways(const Eigen::Isometry3d& rMc);

/// Columns ∂(v, ω)/∂(base speed, base turn rate) of a camera at rMc, in its own frame c.
Eigen::Matrix<double, 6, 2> camera_jacobian_base(const Eigen::Isometry3d& rMc);

/// Pan and tilt that put the optical axis through a point of the base frame (camera_offset_h of
/// zero; a lateral offset is compensated to first order by iterating three times).
HeadAngles aim_at(const HeadGeometry& geometry, const Eigen::Vector3d& p_r);

}  // namespace vigia
