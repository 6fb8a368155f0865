#include "light_rows.hpp"

#include "simd.hpp"

namespace vigia::sim {

VIGIA_PIXEL_LOOP
void LightRows::apply_row(const Constants& constants, const float* __restrict x,
                          const float* __restrict y, const float* __restrict inverse_depth,
                          int count, float* __restrict grey) {
  const Constants k = constants;
  for (int i = 0; i < count; ++i) {
    const float inverse = inverse_depth[i] > 1e-3F ? inverse_depth[i] : 1e-3F;
    const float depth = k.per_width / inverse;
    const float r2 = depth * depth * (x[i] * x[i] + y[i] * y[i] + 1.0F) + 1.0F;
    float gain = k.ambient;
    for (std::size_t j = 0; j < 4; ++j) {
      const float along = k.x[j] * x[i] + k.y[j] * y[i] + k.z[j];
      gain += k.strength[j] / (r2 - 2.0F * depth * along + k.square[j]);
    }
    gain = gain > 0.0F ? gain : 0.0F;
    grey[i] *= gain;
  }
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

void LightRows::apply(const float* x, const float* y, const float* inverse_depth, int count,
                      float* grey) const {
  apply_row(constants_, x, y, inverse_depth, count, grey);
}

}  // namespace vigia::sim
