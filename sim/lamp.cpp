#include "lamp.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::sim {
namespace {

constexpr double kWhite = 6500.0;                           // K
constexpr double kSecondRadiation = 0.01438777;             // m K, Planck's c₂
constexpr double kWavelength[] = {600e-9, 540e-9, 450e-9};  // m, a camera's red, green and blue

}  // namespace

std::array<float, 3> lamp_gains(double kelvin) {
  std::array<double, 3> gain{};
  for (std::size_t c = 0; c < gain.size(); ++c) {
    const double exponent = kSecondRadiation / kWavelength[c];
    gain[c] = std::expm1(exponent / kWhite) / std::expm1(exponent / kelvin);
  }
  const double brightest = *std::max_element(gain.begin(), gain.end());
  std::array<float, 3> result{};
  std::transform(gain.begin(), gain.end(), result.begin(),
                 [&](double g) { return static_cast<float>(g / brightest); });
  return result;
}

float luma(const std::array<float, 3>& rgb) {
  return 0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2];
}

Ink ink(const std::array<float, 3>& rgb) {
  Ink result;
  result.grey = luma(rgb);
  if (result.grey > 0.0F)
    for (std::size_t c = 0; c < rgb.size(); ++c) result.tint[c] = rgb[c] / result.grey;
  return result;
}

Ink lit(const Ink& dry, const std::array<float, 3>& gains) {
  std::array<float, 3> rgb{};
  for (std::size_t c = 0; c < rgb.size(); ++c) rgb[c] = dry.grey * dry.tint[c] * gains[c];
  return ink(rgb);
}

Material lit(Material material, const std::array<float, 3>& gains) {
  const Ink shone = lit(Ink{1.0F, material.tint}, gains);
  material.tint = shone.tint;
  material.base *= shone.grey;
  material.coarse *= shone.grey;
  material.fine *= shone.grey;
  for (float& grey : material.along_s.grey) grey *= shone.grey;
  for (float& grey : material.along_t.grey) grey *= shone.grey;
  return material;
}

}  // namespace vigia::sim
