#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {

/// Φ and φ of the normal distribution, tabulated; linear in between (error below 1e-5).
class NormalTable {
 public:
  static constexpr float kLimit = 4.5F;
  static constexpr int kPerUnit = 64;

  NormalTable() {
    for (int i = 0; i < kSize; ++i) {
      const double t = static_cast<double>(i) / kPerUnit - static_cast<double>(kLimit);
      values_[static_cast<std::size_t>(i)] = {
          static_cast<float>(0.5 * std::erfc(-t / std::sqrt(2.0))),
          static_cast<float>(std::exp(-0.5 * t * t) / std::sqrt(2.0 * kPi))};
    }
  }

  struct Value {
    float integral;
    float density;
  };

  Value at(float t) const {
    const float place = (std::clamp(t, -kLimit, kLimit) + kLimit) * kPerUnit;
    const int index = std::min(static_cast<int>(place), kSize - 2);
    const float rest = place - static_cast<float>(index);
    const Value& low = values_[static_cast<std::size_t>(index)];
    const Value& high = values_[static_cast<std::size_t>(index) + 1];
    return {low.integral + rest * (high.integral - low.integral),
            low.density + rest * (high.density - low.density)};
  }

 private:
  static constexpr int kSize = 2 * 288 + 1;
  std::array<Value, kSize> values_{};
};

inline const NormalTable& normal_table() {
  static const NormalTable table;
  return table;
}

}  // namespace vigia::tracking
