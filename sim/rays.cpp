#include "rays.hpp"

#include "simd.hpp"

#include <cmath>

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

struct RowRays {
  int u, v, count;
  float *x, *y, *z;

  void operator()(const Intrinsics& k) const {
    bend(static_cast<float>(-k.u0 / k.px), static_cast<float>(1.0 / k.px),
         static_cast<float>((v - k.v0) / k.py), static_cast<float>(k.kdu), u, count, x, y);
  }
  void operator()(const UnifiedOmni& k) const {
    const CameraModel model = k;
    for (int i = 0; i < count; ++i) {
      const auto seen = ray(model, {u + i, v});
      x[i] = seen ? static_cast<float>(seen->x()) : 0.0F;
      y[i] = seen ? static_cast<float>(seen->y()) : 0.0F;
      z[i] = seen ? static_cast<float>(seen->z()) : 0.0F;
    }
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

Eigen::Vector3d point_ray(const CameraModel& model, const Eigen::Vector2d& uv) {
  return std::visit(PointRay{uv}, model);
}

double resolution_px(const CameraModel& model) {
  return std::visit(Resolution{}, model);
}

}  // namespace vigia::sim
