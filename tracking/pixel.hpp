#pragma once

namespace vigia::tracking {

/// Blur of an edge by the pixel's own integration, 1/√12 px.
inline constexpr double kPixelBlur = 0.29;
/// Blur at which the fit of an edge starts, px.
inline constexpr double kStartBlur = 0.8;
/// Variance of a grey level by its rounding.
inline constexpr double kQuantisationVariance = 1.0 / 12.0;

}  // namespace vigia::tracking
