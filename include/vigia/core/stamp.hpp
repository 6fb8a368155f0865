#pragma once

#include <cmath>
#include <cstdint>

namespace vigia {

/// A span of time in integer nanoseconds.
struct Duration {
  std::int64_t ns = 0;

  /// The nearest nanosecond to @p s seconds.
  static Duration from_seconds(double s) { return {std::llround(s * 1e9)}; }
  double seconds() const { return static_cast<double>(ns) * 1e-9; }
};

/// A point in mission time, integer nanoseconds since the mission's start.
struct Stamp {
  std::int64_t ns = 0;

  static Stamp from_seconds(double s) { return {std::llround(s * 1e9)}; }
  double seconds() const { return static_cast<double>(ns) * 1e-9; }
};

constexpr Duration operator-(Stamp a, Stamp b) {
  return {a.ns - b.ns};
}
constexpr Stamp operator+(Stamp a, Duration d) {
  return {a.ns + d.ns};
}
constexpr Stamp operator-(Stamp a, Duration d) {
  return {a.ns - d.ns};
}

constexpr bool operator==(Stamp a, Stamp b) {
  return a.ns == b.ns;
}
constexpr bool operator!=(Stamp a, Stamp b) {
  return a.ns != b.ns;
}
constexpr bool operator<(Stamp a, Stamp b) {
  return a.ns < b.ns;
}
constexpr bool operator<=(Stamp a, Stamp b) {
  return a.ns <= b.ns;
}
constexpr bool operator>(Stamp a, Stamp b) {
  return a.ns > b.ns;
}
constexpr bool operator>=(Stamp a, Stamp b) {
  return a.ns >= b.ns;
}
constexpr bool operator<(Duration a, Duration b) {
  return a.ns < b.ns;
}
constexpr bool operator>(Duration a, Duration b) {
  return a.ns > b.ns;
}
constexpr bool operator<=(Duration a, Duration b) {
  return a.ns <= b.ns;
}
constexpr bool operator>=(Duration a, Duration b) {
  return a.ns >= b.ns;
}

}  // namespace vigia
