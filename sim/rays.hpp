#pragma once

#include <cstddef>
#include <cstdint>

#include "vigia/core/camera_model.hpp"

namespace vigia::sim {

/// Directions of neighbouring pixels in frame c: (x, y, 1) of a perspective camera, whose z is
/// null; unit vectors (x, y, z) of any other, and zero where a pixel shows nothing.
struct Rays {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;

  Rays from(std::ptrdiff_t i) const { return {x + i, y + i, z == nullptr ? nullptr : z + i}; }
};

/// Whether the rays of the model are (x, y, 1).
inline bool is_perspective(const CameraModel& model) {
  return std::holds_alternative<Intrinsics>(model);
}

/// Rays of @p count pixels of row @p v from column @p u on, through the lens. @p z is not touched
/// for a perspective camera.
void row_rays(const CameraModel& model, int u, int v, int count, float* x, float* y, float* z);

/// The same of pixels (u[i], v[i]) of a camera that is not perspective.
void pixel_rays(const UnifiedOmni& model, const std::int32_t* u, const std::int32_t* v, int count,
                float* x, float* y, float* z);

/// The ray of any point of the image, as row_rays() has it; zero where it shows nothing.
Eigen::Vector3d point_ray(const CameraModel& model, const Eigen::Vector2d& uv);

/// Pixels a radian in the middle of the image.
double resolution_px(const CameraModel& model);

}  // namespace vigia::sim
