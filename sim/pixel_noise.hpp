#pragma once

#include <cstdint>
#include <vector>

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

  /// What the numbers of a channel's rows follow from, for the same of pixels (u[i], v[i]).
  std::vector<std::uint32_t> row_keys(int channel, int rows) const;
  static void add_and_round(const float* value, float sigma, const std::uint32_t* row_keys,
                            const std::int32_t* u, const std::int32_t* v, int count,
                            unsigned char* out);

 private:
  std::uint32_t row_key(int channel, int v) const;

  std::uint64_t key_;
};

}  // namespace vigia::sim
