#pragma once

#include <cmath>

#include "vigia/core/angle.hpp"

namespace vigia::localization {

/// The density of a zero-mean normal variable of this variance at @p x.
inline double normal_density(double x, double variance) {
  return std::exp(-0.5 * x * x / variance) / std::sqrt(2.0 * kPi * variance);
}

}  // namespace vigia::localization
