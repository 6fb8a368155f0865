#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/camera.hpp"

namespace vigia::localization {

/// Adán's viewing parameters of a pattern on the optical axis. World axes of the paper on the
/// pattern: Z_w up through the first point (y of frame l), Y_w the normal towards the viewer (z of
/// l), X_w = −x of l. Camera axes e: x left, y up, z forward (c turned by 180° about z).
struct ViewParameters {
  double phi = 0.0;    ///< "tilt": angle between normal and line of sight, [0, π/2), frontal = 0
  double theta = 0.0;  ///< "pan": from Z_w to the line of sight in the pattern's plane, (−π, π]
  double psi = 0.0;    ///< "swing": of the image about the optical axis, (−π, π]
  double distance = 0.0;  ///< D, from the optical centre to the centre-point, m; D' = D + f
};

/// Adán eq. 15 with entry (1,3) mended to −sin θ, turned by ψ: the pose of a pattern whose
/// centre-point lies on the optical axis.
Eigen::Isometry3d pose_of(const ViewParameters& view);

/// The parameters of any pose, in the camera turned so that its axis passes through the landmark's
/// centre (see sight_rotation()). Frontal views have no θ of their own: θ + ψ counts.
ViewParameters view_of(const Eigen::Isometry3d& cMl);

/// The 180° twin: the plane mirrored in the line of sight, θ + π and ψ + π. From afar both look the
/// same; perspective alone tells them apart.
ViewParameters twin_of(const ViewParameters& view);
/// The twin of any pose, about its own line of sight.
Eigen::Isometry3d twin_of(const Eigen::Isometry3d& cMl);

/// vRc: the smallest rotation that brings the direction @p p_c onto the optical axis of a turned
/// camera v.
Eigen::Matrix3d sight_rotation(const Eigen::Vector3d& p_c);

/// The image as the camera would have seen it whose axis passes through the pixel @p centre: the
/// homography of a pure rotation, on normalised undistorted points.
struct CentredImage {
  Eigen::Matrix3d vRc;                  ///< to undo: cMl.linear() = vRcᵀ · vMl.linear(), …
  std::vector<Eigen::Vector2d> points;  ///< normalised, in the turned camera
};

CentredImage centre_image(const Intrinsics& intrinsics, const Eigen::Vector2d& centre,
                          const std::vector<Eigen::Vector2d>& uv);

}  // namespace vigia::localization
