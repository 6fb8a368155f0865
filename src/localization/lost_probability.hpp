#pragma once

#include <algorithm>
#include <cmath>

namespace vigia::localization {

// What goes into Belief::lost_probability.

/// Of a filter that says that it is lost: it may be wrong.
inline constexpr double kSaidLost = 0.99;

/// That a position of σ = √λ_max is off by more than half a metre, at most.
inline double probability_of_half_a_metre(double sigma_m) {
  return std::exp(-0.125 / std::max(sigma_m * sigma_m, 1e-9));
}

/// Of @p rejections unexplained images in a row, of which @p limit make a filter say that it is
/// lost.
inline double rejection_probability(int rejections, int limit) {
  return 0.5 * std::min(1.0, static_cast<double>(rejections) / limit);
}

/// Of a test statistic that exceeds what was seen with probability @p tail, where a filter says
/// that it is lost at @p alpha: even odds there.
inline double tail_evidence(double tail, double alpha) {
  return alpha / (alpha + tail);
}

/// At least one of two things that have nothing to do with each other.
inline double either(double p, double q) {
  return p + q - p * q;
}

}  // namespace vigia::localization
