#pragma once

#include <array>

namespace vigia::tracking {

/// Pixels are handled in groups of so many: arrays are padded to a multiple of it.
constexpr int kLanes = 8;
constexpr int padded(int count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

/// An ellipse and its edge's blur, for the loops below.
struct OutlineConstants {
  float shift_u, shift_v;     ///< of the centre, from the origin of the coordinates
  float a11, a12, a22;        ///< Σ⁻¹
  float inverse_determinant;  ///< 1/det Σ
  float blur;
};

/// Where pixels lie with respect to the outline.
struct OutlinePlaces {
  float* nx;  ///< outward normal at the foot point
  float* ny;
  float* h;  ///< support function of the outline there
  float* curvature;
  float* t;  ///< distance (positive inside) in blurs, freed of the shift of a curved edge
};

/// The places of @p count pixels at (u, v).
void place_pixels(const OutlineConstants& outline, const float* u, const float* v, int count,
                  const OutlinePlaces& places);

/// Columns of the Jacobian of the edge model, in the order u, v, Σ₁₁, Σ₁₂, Σ₂₂, ground, contrast,
/// blur.
using JacobianColumns = std::array<float*, 8>;

/// Fills the columns of centre, Σ and blur, given the model's density φ(t) at each pixel.
void differentiate_edge(const OutlinePlaces& places, const float* density, float contrast,
                        float blur, int count, const JacobianColumns& columns);

/// JᵀJ, its lower triangle row by row, over @p count pixels, a multiple of kLanes. The order of the
/// additions is fixed.
std::array<float, 36> normal_sums(const JacobianColumns& columns, int count);

/// Jᵀr likewise.
std::array<float, 8> gradient_sums(const JacobianColumns& columns, const float* residual,
                                   int count);

/// A mixture of red, green and blue with its offset, in 4096ths.
struct ChannelMixture {
  int red, green, blue, offset;
};

/// out[i] = the mixture of pixel i of a row of R, G, B, A bytes, clamped to 0–255.
void mix_channels(const unsigned char* rgba, const ChannelMixture& mixture, int count,
                  unsigned char* out);

}  // namespace vigia::tracking
