#include "vigia/core/random.hpp"

namespace vigia {
namespace {

std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

std::uint64_t derive_seed(std::uint64_t seed, std::string_view name) {
  std::uint64_t mixed = splitmix64(seed);
  for (const char c : name) mixed = splitmix64(mixed ^ static_cast<unsigned char>(c));
  return mixed;
}

std::uint64_t derive_seed(std::uint64_t seed, std::uint64_t number) {
  return splitmix64(splitmix64(seed) ^ number);
}

std::size_t RandomStream::index(std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_);
}

}  // namespace vigia
