#pragma once

#include <optional>
#include <variant>

#include <Eigen/Core>

#include "vigia/core/angle.hpp"
#include "vigia/core/camera.hpp"

namespace vigia {

/// A central mirror or fisheye camera by the unified model (Geyer & Daniilidis 2000, Mei & Rives
/// 2007): the direction to a point, a point of the unit sphere X_s = X/|X|, is seen from a centre
/// that lies ξ behind the sphere's, m = (X_s, Y_s)/(Z_s + ξ), and u = u0 + px m_x, v = v0 + py m_y.
/// ξ = 0 is the pinhole without distortion, ξ = 1 the parabolic mirror. Frame c is the mirror's: z
/// along its axis, the direction that is seen in the middle of the image. A mirror turns the image
/// over; one of px and py is then negative.
struct UnifiedOmni {
  int width = 640;
  int height = 480;
  double xi = 1.0;    ///< 1, ≥ 0
  double px = 230.0;  ///< px
  double py = 230.0;  ///< px
  double u0 = 319.5;
  double v0 = 239.5;
  double max_angle = from_deg(105.0);  ///< rad off the axis, the edge of mirror or lens
};

/// Smallest z of the unit directions that are seen.
double min_z(const UnifiedOmni& omni);

/// What turns directions of frame c into pixels.
using CameraModel = std::variant<Intrinsics, UnifiedOmni>;

int image_width(const CameraModel& model);
int image_height(const CameraModel& model);

/// The unit direction, in frame c, of what the pixel @p uv shows. Nothing where the pixel shows
/// nothing: beyond the edge of a mirror.
std::optional<Eigen::Vector3d> ray(const CameraModel& model, const Eigen::Vector2d& uv);

/// Pixel of a point in frame c, or nothing when it lies beyond the model's field: behind a pinhole,
/// beyond the distortion's fold or the mirror's edge. The pixel may lie outside the image.
std::optional<Eigen::Vector2d> project(const CameraModel& model, const Eigen::Vector3d& p_c);

/// ∂(u,v)/∂p_c, px per metre, where project() has a pixel.
std::optional<Eigen::Matrix<double, 2, 3>> project_jacobian(const CameraModel& model,
                                                            const Eigen::Vector3d& p_c);

/// ∂ray/∂(u,v), per px, where ray() has a direction.
std::optional<Eigen::Matrix<double, 3, 2>> ray_jacobian(const CameraModel& model,
                                                        const Eigen::Vector2d& uv);

/// Whether a pixel lies inside the image by at least @p margin pixels.
bool in_image(const CameraModel& model, const Eigen::Vector2d& uv, double margin = 0.0);

}  // namespace vigia
