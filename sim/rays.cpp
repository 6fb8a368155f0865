#include "rays.hpp"

#include "simd.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace vigia::sim {
namespace {

VIGIA_PIXEL_LOOP
void bend(float x0, float dx, float y, float kdu, int u, int count, float* __restrict out_x,
          float* __restrict out_y) {
  for (int i = 0; i < count; ++i) {
    const float x = x0 + static_cast<float>(u + i) * dx;
    const float scale = 1.0F + kdu * (x * x + y * y);
    out_x[i] = x * scale;
    out_y[i] = y * scale;
  }
}

struct OmniPixels {
  float x0, dx, xi, min_z;
  double v0, py;
};

OmniPixels pixels_of(const UnifiedOmni& k) {
  return {static_cast<float>(-k.u0 / k.px),
          static_cast<float>(1.0 / k.px),
          static_cast<float>(k.xi),
          static_cast<float>(min_z(k)),
          k.v0,
          k.py};
}

/// Mei & Rives eq. 4.
VIGIA_PIXEL_BODY void lift_to_sphere(const OmniPixels& k, std::int32_t u, float y,
                                     float& __restrict out_x, float& __restrict out_y,
                                     float& __restrict out_z) {
  const float x = k.x0 + static_cast<float>(u) * k.dx;
  const float r2 = x * x + y * y;
  const float root2 = 1.0F + (1.0F - k.xi * k.xi) * r2;
  const float root = std::sqrt(root2 > 0.0F ? root2 : 0.0F);
  const float eta = (k.xi + root) / (1.0F + r2);
  const bool seen = (root2 >= 0.0F) & (eta - k.xi >= k.min_z);
  out_x = seen ? eta * x : 0.0F;
  out_y = seen ? eta * y : 0.0F;
  out_z = seen ? eta - k.xi : 0.0F;
}

VIGIA_PIXEL_LOOP
void lift_row(const OmniPixels& pixels, int u, float y, int count, float* __restrict out_x,
              float* __restrict out_y, float* __restrict out_z) {
  const OmniPixels k = pixels;
  for (int i = 0; i < count; ++i) lift_to_sphere(k, u + i, y, out_x[i], out_y[i], out_z[i]);
}

VIGIA_PIXEL_LOOP
void lift_pixels(const OmniPixels& pixels, const std::int32_t* __restrict u,
                 const std::int32_t* __restrict v, int count, float* __restrict out_x,
                 float* __restrict out_y, float* __restrict out_z) {
  const OmniPixels k = pixels;
  for (int i = 0; i < count; ++i)
    lift_to_sphere(k, u[i], static_cast<float>((v[i] - k.v0) / k.py), out_x[i], out_y[i], out_z[i]);
}

struct RowRays {
  int u, v, count;
  float *x, *y, *z;

  void operator()(const Intrinsics& k) const {
    bend(static_cast<float>(-k.u0 / k.px), static_cast<float>(1.0 / k.px),
         static_cast<float>((v - k.v0) / k.py), static_cast<float>(k.kdu), u, count, x, y);
  }
  void operator()(const UnifiedOmni& k) const {
    lift_row(pixels_of(k), u, static_cast<float>((v - k.v0) / k.py), count, x, y, z);
  }
};

struct PointRay {
  const Eigen::Vector2d& uv;

  Eigen::Vector3d operator()(const Intrinsics& k) const { return unproject(k, uv).homogeneous(); }
  Eigen::Vector3d operator()(const UnifiedOmni& k) const {
    return ray(CameraModel{k}, uv).value_or(Eigen::Vector3d::Zero());
  }
};

struct Resolution {
  double operator()(const Intrinsics& k) const { return k.px; }
  double operator()(const UnifiedOmni& k) const { return std::abs(k.px) / (1.0 + k.xi); }
};

}  // namespace

void row_rays(const CameraModel& model, int u, int v, int count, float* x, float* y, float* z) {
  std::visit(RowRays{u, v, count, x, y, z}, model);
}

void pixel_rays(const UnifiedOmni& model, const std::int32_t* u, const std::int32_t* v, int count,
                float* x, float* y, float* z) {
  lift_pixels(pixels_of(model), u, v, count, x, y, z);
}

Eigen::Vector3d point_ray(const CameraModel& model, const Eigen::Vector2d& uv) {
  return std::visit(PointRay{uv}, model);
}

double resolution_px(const CameraModel& model) {
  return std::visit(Resolution{}, model);
}

}  // namespace vigia::sim
