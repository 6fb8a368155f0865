#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace vigia {

/// A mix of a seed and a name or number: the seed of a stream of its own (splitmix64 finaliser).
std::uint64_t derive_seed(std::uint64_t seed, std::string_view name);
std::uint64_t derive_seed(std::uint64_t seed, std::uint64_t number);

/// A consumer's own random numbers, derived from the mission's seed and the consumer's name: a new
/// consumer moves no other.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name) : engine_(derive_seed(seed, name)) {}

  /// Standard normal.
  double normal() { return normal_(engine_); }
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * unit_(engine_); }
  /// Uniform integer in [0, count).
  std::size_t index(std::size_t count);
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> unit_;
};

}  // namespace vigia
