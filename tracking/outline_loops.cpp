#include "outline_loops.hpp"

#include <cmath>
#include <cstring>

// Compiled for AVX2 as well, and the processor chooses. Both give the same bytes: the arithmetic is
// IEEE single precision, lane by lane, without contraction.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define VIGIA_OUTLINE_LOOP __attribute__((target_clones("avx2", "default")))
#define VIGIA_INLINE __attribute__((always_inline)) inline
#else
#define VIGIA_OUTLINE_LOOP
#define VIGIA_INLINE inline
#endif

namespace vigia::tracking {
namespace {

constexpr std::size_t kColumns = 8;

using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

// Sums over pixels of one column's products with the first Count of others, lane by lane.
template <std::size_t Count>
VIGIA_INLINE void products(const float* column, const JacobianColumns& others, int count,
                           float* out) {
  Lanes sums[Count] = {};
  for (int i = 0; i < count; i += kLanes) {
    Lanes mine;
    std::memcpy(&mine, column + i, sizeof mine);
#pragma GCC unroll 8
    for (std::size_t j = 0; j < Count; ++j) {
      Lanes theirs;
      std::memcpy(&theirs, others[j] + i, sizeof theirs);
      sums[j] += mine * theirs;
    }
  }
  for (std::size_t j = 0; j < Count; ++j) {
    out[j] = 0.0F;
    for (int lane = 0; lane < kLanes; ++lane) out[j] += sums[j][lane];
  }
}

VIGIA_INLINE void place(const OutlineConstants& k, int count, const float* __restrict u,
                        const float* __restrict v, float* __restrict nx_out,
                        float* __restrict ny_out, float* __restrict h_out,
                        float* __restrict curvature_out, float* __restrict t_out) {
  const float shift = 0.5F * k.blur * k.blur;
  const float scale = 1.0F / k.blur;
  for (int i = 0; i < count; ++i) {
    float x = u[i] - k.shift_u;
    float y = v[i] - k.shift_v;
    // The first-order distance to the outline, then once more from the foot point that it leads
    // to: third order in distance times curvature.
    float gx = k.a11 * x + k.a12 * y;
    float gy = k.a12 * x + k.a22 * y;
    float inverse = 1.0F / std::sqrt(gx * gx + gy * gy + 1e-18F);
    float level = std::sqrt(x * gx + y * gy);
    const float first = (1.0F - level) * level * inverse;
    x += first * gx * inverse;
    y += first * gy * inverse;
    gx = k.a11 * x + k.a12 * y;
    gy = k.a12 * x + k.a22 * y;
    inverse = 1.0F / std::sqrt(gx * gx + gy * gy + 1e-18F);
    level = std::sqrt(x * gx + y * gy);
    const float distance = first + (1.0F - level) * level * inverse;
    const float nx = gx * inverse;
    const float ny = gy * inverse;
    const float support = x * nx + y * ny;
    const float h = support > 0.1F ? support : 0.1F;
    const float curvature = h * h * h * k.inverse_determinant;
    nx_out[i] = nx;
    ny_out[i] = ny;
    h_out[i] = h;
    curvature_out[i] = curvature;
    t_out[i] = (distance - shift * curvature) * scale;
  }
}

VIGIA_INLINE void differentiate(float contrast, float blur, int count, const float* __restrict nx,
                                const float* __restrict ny, const float* __restrict h,
                                const float* __restrict curvature, const float* __restrict t,
                                const float* __restrict phi, float* __restrict du,
                                float* __restrict dv, float* __restrict dp, float* __restrict dq,
                                float* __restrict dr, float* __restrict ds) {
  const float steep = contrast / blur;
  for (int i = 0; i < count; ++i) {
    // ∂g/∂d, then the outline's movement with centre and Σ: ∂d/∂c = n, ∂d/∂Σ = n nᵀ/(2h).
    const float edge = -steep * phi[i];
    const float over_h = edge / h[i];
    ds[i] = steep * phi[i] * (t[i] + blur * curvature[i]);
    du[i] = edge * nx[i];
    dv[i] = edge * ny[i];
    dp[i] = 0.5F * over_h * nx[i] * nx[i];
    dq[i] = over_h * nx[i] * ny[i];
    dr[i] = 0.5F * over_h * ny[i] * ny[i];
  }
}

}  // namespace

VIGIA_OUTLINE_LOOP
void place_pixels(const OutlineConstants& outline, const float* u, const float* v, int count,
                  const OutlinePlaces& places) {
  const OutlineConstants constants = outline;
  place(constants, count, u, v, places.nx, places.ny, places.h, places.curvature, places.t);
}

VIGIA_OUTLINE_LOOP
void differentiate_edge(const OutlinePlaces& places, const float* density, float contrast,
                        float blur, int count, const JacobianColumns& columns) {
  differentiate(contrast, blur, count, places.nx, places.ny, places.h, places.curvature, places.t,
                density, columns[0], columns[1], columns[2], columns[3], columns[4], columns[7]);
}

VIGIA_OUTLINE_LOOP
std::array<float, 36> normal_sums(const JacobianColumns& columns, int count) {
  std::array<float, 36> out{};
  float* row = out.data();
  products<1>(columns[0], columns, count, row);
  products<2>(columns[1], columns, count, row + 1);
  products<3>(columns[2], columns, count, row + 3);
  products<4>(columns[3], columns, count, row + 6);
  products<5>(columns[4], columns, count, row + 10);
  products<6>(columns[5], columns, count, row + 15);
  products<7>(columns[6], columns, count, row + 21);
  products<8>(columns[7], columns, count, row + 28);
  return out;
}

VIGIA_OUTLINE_LOOP
std::array<float, 8> gradient_sums(const JacobianColumns& columns, const float* residual,
                                   int count) {
  std::array<float, 8> out{};
  products<kColumns>(residual, columns, count, out.data());
  return out;
}

VIGIA_OUTLINE_LOOP
void mix_channels(const unsigned char* __restrict rgba, const ChannelMixture& mixture, int count,
                  unsigned char* __restrict out) {
  const ChannelMixture m = mixture;
  for (int i = 0; i < count; ++i) {
    const int sum = m.red * rgba[4 * i] + m.green * rgba[4 * i + 1] + m.blue * rgba[4 * i + 2];
    int value = (sum + m.offset) >> 12;
    value = value > 0 ? value : 0;
    out[i] = static_cast<unsigned char>(value < 255 ? value : 255);
  }
}

}  // namespace vigia::tracking
