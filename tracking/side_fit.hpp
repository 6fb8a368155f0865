#pragma once

#include <optional>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

#include "vigia/imaging/frame.hpp"

namespace vigia::tracking {

/// A straight edge between dark and light: the points with normal · (x − middle) = 0, the normal
/// towards the light.
struct SideFit {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  /// Of the displacement of the middle along the normal (px) and of the turn (rad).
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  double blur = 0.8;      ///< σ, with the pixel's own integration, px
  double contrast = 0.0;  ///< grey levels
  double noise = 0.0;     ///< of the residuals, grey levels

  /// Variance of the line's place along its normal, beside the foot of @p point.
  double variance_at(const Eigen::Vector2d& point) const;
};

/// The sides of a dark quadrilateral, for which the band along a side is @p half_width px at most
/// on either side.
struct SideBand {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  Eigen::Vector2d inside;  ///< any point on the dark side
  double half_width = 3.0;
};

/// Fits a blurred edge g(x) = D + (L − D)·Φ(d/s) to the grey values in a band along a side by
/// Gauss–Newton: place, turn, both levels and blur together. The ends, where the next sides' blur
/// reaches, are left out. Nothing when there is no such edge.
std::optional<SideFit> fit_side(const vpImage<unsigned char>& image, const SideBand& band);

struct Corner {
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};

/// Where two sides meet. Nothing when they are nearly parallel.
std::optional<Corner> meet(const SideFit& a, const SideFit& b);

/// The Cramér–Rao bound of the place of a fitted straight edge at its own end, along its normal:
/// σ_n² = 4/(ρ L), ρ = (C/σ)²/(2√π s) the information per pixel of length; L the length, C the
/// contrast, σ the noise, s the blur with the pixel's integration; levels and blur known. At a
/// right-angled corner each coordinate has this bound from one of the two sides.
double corner_bound(double length, double contrast, double noise, double blur);

}  // namespace vigia::tracking
