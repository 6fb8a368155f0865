#pragma once

#include "texture.hpp"

#include <array>

namespace vigia::sim {

/// What a lamp of @p kelvin makes of red, green and blue in a camera that is white at 6500 K:
/// Planck's radiation at three wavelengths, the brightest channel exposed as before. 1, 1, 1 at
/// 6500 K.
std::array<float, 3> lamp_gains(double kelvin);

/// Rec. 709 luma of a colour.
float luma(const std::array<float, 3>& rgb);

/// A colour as its grey (luma) and the tint of that grey (luma 1).
struct Ink {
  float grey = 60.0F;
  std::array<float, 3> tint{1.0F, 1.0F, 1.0F};
};
Ink ink(const std::array<float, 3>& rgb);

/// The colour under a lamp.
Ink lit(const Ink& ink, const std::array<float, 3>& gains);
Material lit(Material material, const std::array<float, 3>& gains);

}  // namespace vigia::sim
