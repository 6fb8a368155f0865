#include "light_rows.hpp"

#include "simd.hpp"

namespace vigia::sim {

template <bool kPerspective>
VIGIA_PIXEL_BODY void LightRows::apply_row(const Constants& constants, const Rays& rays,
                                           const float* __restrict inverse_depth, int count,
                                           float* __restrict grey) {
  const Constants k = constants;
  const float* __restrict x = rays.x;
  const float* __restrict y = rays.y;
  const float* __restrict rz = rays.z;
  for (int i = 0; i < count; ++i) {
    const float z = kPerspective ? 1.0F : rz[i];
    const float inverse = inverse_depth[i] > 1e-3F ? inverse_depth[i] : 1e-3F;
    const float depth = k.per_width / inverse;
    const float r2 = depth * depth * (x[i] * x[i] + y[i] * y[i] + z * z) + 1.0F;
    float gain = k.ambient;
    for (std::size_t j = 0; j < 4; ++j) {
      const float along = k.x[j] * x[i] + k.y[j] * y[i] + k.z[j] * z;
      gain += k.strength[j] / (r2 - 2.0F * depth * along + k.square[j]);
    }
    gain = gain > 0.0F ? gain : 0.0F;
    grey[i] *= gain;
  }
}

VIGIA_PIXEL_LOOP
void LightRows::apply_perspective(const Constants& constants, const Rays& rays,
                                  const float* inverse_depth, int count, float* grey) {
  apply_row<true>(constants, rays, inverse_depth, count, grey);
}

VIGIA_PIXEL_LOOP
void LightRows::apply_any(const Constants& constants, const Rays& rays, const float* inverse_depth,
                          int count, float* grey) {
  apply_row<false>(constants, rays, inverse_depth, count, grey);
}

LightRows::LightRows(const LightNow& light, const Eigen::Isometry3d& cMw) {
  for (std::size_t j = 0; j < light.lamps.size(); ++j) {
    const Eigen::Vector3d p = cMw * light.lamps[j].p_w / light.width_m;
    constants_.x[j] = static_cast<float>(p.x());
    constants_.y[j] = static_cast<float>(p.y());
    constants_.z[j] = static_cast<float>(p.z());
    constants_.square[j] = static_cast<float>(p.squaredNorm());
    constants_.strength[j] = static_cast<float>(light.lamps[j].strength);
  }
  constants_.ambient = static_cast<float>(light.ambient);
  constants_.per_width = static_cast<float>(1.0 / light.width_m);
}

void LightRows::apply(const Rays& rays, const float* inverse_depth, int count, float* grey) const {
  if (rays.z == nullptr)
    apply_perspective(constants_, rays, inverse_depth, count, grey);
  else
    apply_any(constants_, rays, inverse_depth, count, grey);
}

}  // namespace vigia::sim
