#include "rays.hpp"

#include "simd.hpp"

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

}  // namespace

void row_rays(const Intrinsics& k, int u, int v, int count, float* x, float* y) {
  bend(static_cast<float>(-k.u0 / k.px), static_cast<float>(1.0 / k.px),
       static_cast<float>((v - k.v0) / k.py), static_cast<float>(k.kdu), u, count, x, y);
}

}  // namespace vigia::sim
