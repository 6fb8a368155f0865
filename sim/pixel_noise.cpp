#include "pixel_noise.hpp"

#include "simd.hpp"

#include <array>
#include <cmath>

#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

constexpr int kTableBits = 12;
constexpr int kTableSize = 1 << kTableBits;

/// The quantile x with Φ(x) = p, by Newton steps from 0 in the tail-safe direction.
double normal_quantile(double p) {
  double x = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double error = 0.5 * std::erfc(-x / std::sqrt(2.0)) - p;
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * 3.14159265358979323846);
    x -= std::fmax(-0.5, std::fmin(0.5, error / density));
  }
  return x;
}

/// Quantiles at the middles of equal shares of probability, scaled to unit variance.
std::array<float, kTableSize> normal_table() {
  std::array<double, kTableSize> x{};
  double sum = 0.0;
  for (int i = 0; i < kTableSize / 2; ++i) {
    const double quantile = normal_quantile((i + 0.5) / kTableSize);
    x[static_cast<std::size_t>(i)] = quantile;
    x[static_cast<std::size_t>(kTableSize - 1 - i)] = -quantile;
    sum += 2.0 * quantile * quantile;
  }
  const double scale = 1.0 / std::sqrt(sum / kTableSize);
  std::array<float, kTableSize> table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<float>(scale * x[i]);
  return table;
}

/// Made when the first picture is: many a run of the program makes none.
const float* normal_numbers() {
  static const std::array<float, kTableSize> table = normal_table();
  return table.data();
}

VIGIA_PIXEL_BODY unsigned char noisy_pixel(float value, const float* table, float sigma,
                                           std::uint32_t row_key, std::uint32_t u) {
  // Finaliser of MurmurHash3, which lets every input bit change every output bit.
  std::uint32_t h = (u * 0x9e3779b1U) ^ row_key;
  h ^= h >> 16;
  h *= 0x85ebca6bU;
  h ^= h >> 13;
  h *= 0xc2b2ae35U;
  const auto index = static_cast<std::int32_t>(h >> (32 - kTableBits));
  float grey = value + sigma * table[index] + 0.5F;
  grey = grey > 0.0F ? grey : 0.0F;
  grey = grey < 255.0F ? grey : 255.0F;
  return static_cast<unsigned char>(static_cast<std::int32_t>(grey));
}

VIGIA_PIXEL_LOOP
void noisy_row(const float* __restrict value, const float* __restrict table, float sigma,
               std::uint32_t row_key, std::uint32_t u, int count, unsigned char* __restrict out) {
  for (int i = 0; i < count; ++i)
    out[i] = noisy_pixel(value[i], table, sigma, row_key, u + static_cast<std::uint32_t>(i));
}

VIGIA_PIXEL_LOOP
void noisy_pixels(const float* __restrict value, const float* __restrict table, float sigma,
                  const std::uint32_t* __restrict row_keys, const std::int32_t* __restrict u,
                  const std::int32_t* __restrict v, int count, unsigned char* __restrict out) {
  for (int i = 0; i < count; ++i)
    out[i] = noisy_pixel(value[i], table, sigma, row_keys[v[i]], static_cast<std::uint32_t>(u[i]));
}

/// Cameras that expose at once have noise of their own. That of camera 0 is the seed's.
std::uint64_t of_camera(std::uint64_t seed, CameraId camera) {
  if (camera == 0) return seed;
  return derive_seed(derive_seed(seed, "camera"), static_cast<std::uint64_t>(camera));
}

}  // namespace

PixelNoise::PixelNoise(std::uint64_t seed, CameraId camera, Stamp stamp)
    : key_(derive_seed(of_camera(seed, camera), static_cast<std::uint64_t>(stamp.ns))) {}

std::uint32_t PixelNoise::row_key(int channel, int v) const {
  const auto line = (static_cast<std::uint64_t>(channel) << 32) | static_cast<std::uint32_t>(v);
  return static_cast<std::uint32_t>(derive_seed(key_, line) >> 32);
}

void PixelNoise::add_and_round(const float* value, float sigma, int u, int v, int channel,
                               int count, unsigned char* out) const {
  noisy_row(value, normal_numbers(), sigma, row_key(channel, v), static_cast<std::uint32_t>(u),
            count, out);
}

std::vector<std::uint32_t> PixelNoise::row_keys(int channel, int rows) const {
  std::vector<std::uint32_t> keys;
  keys.reserve(static_cast<std::size_t>(rows));
  for (int v = 0; v < rows; ++v) keys.push_back(row_key(channel, v));
  return keys;
}

void PixelNoise::add_and_round(const float* value, float sigma, const std::uint32_t* row_keys,
                               const std::int32_t* u, const std::int32_t* v, int count,
                               unsigned char* out) {
  noisy_pixels(value, normal_numbers(), sigma, row_keys, u, v, count, out);
}

}  // namespace vigia::sim
