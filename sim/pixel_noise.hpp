#pragma once

#include <cstdint>

#include "vigia/core/shot.hpp"

namespace vigia::sim {

/// Noise of one exposure: a standard normal number for each pixel, a function of seed, camera,
/// stamp, channel, u and v alone.
class PixelNoise {
 public:
  PixelNoise(std::uint64_t seed, CameraId camera, Stamp stamp);

  /// out[i] = clamp(round(value[i] + sigma · noise(u + i, v))), 0…255.
  void add_and_round(const float* value, float sigma, int u, int v, int channel, int count,
                     unsigned char* out) const;

 private:
  std::uint64_t key_;
};

}  // namespace vigia::sim
