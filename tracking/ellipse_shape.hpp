#pragma once

#include <vector>

#include <Eigen/Core>

#include "vigia/core/observation.hpp"
#include "vigia/imaging/frame.hpp"

namespace vigia::tracking {

/// An ellipse as centre c and shape matrix Σ = R(ψ) diag(a², b²) R(ψ)ᵀ: the points with
/// (x−c)ᵀ Σ⁻¹ (x−c) = 1. Unlike (a, b, ψ) it is regular for a circle. Pixels.
struct EllipseShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Matrix2d sigma = Eigen::Matrix2d::Identity();
};

EllipseShape shape_of(const Ellipse& ellipse);
Ellipse ellipse_of(const EllipseShape& shape);

/// √(ab), px.
double size_of(const EllipseShape& shape);

/// Signed distance, to first order, of a point from the ellipse's outline, positive inside, px:
/// @p offset is from the ellipse's centre, @p inverse is Σ⁻¹.
double depth_in(const Eigen::Matrix2d& inverse, const Eigen::Vector2d& offset);

/// Half width and half height of the upright rectangle round the ellipse.
Eigen::Vector2d half_extent(const EllipseShape& shape);

/// The whole pixels within the ellipse's upright rectangle grown by @p margin.
imaging::Window window_round(const EllipseShape& shape, double margin);

/// The pixels of a row in a band round an outline: first to last without those of the hole, which
/// is empty where hole_last < hole_first.
struct BandRow {
  int v = 0;
  int first = 0;
  int hole_first = 0;
  int hole_last = -1;
  int last = 0;
};

/// Whether the ellipse that is @p half_width smaller is at least half a pixel.
bool band_has_hole(const Ellipse& ellipse, double half_width);

/// The band between the ellipses of the same directions whose axes are @p half_width longer and
/// shorter, by its rows.
std::vector<BandRow> band_rows(const EllipseShape& shape, double half_width);

/// An ellipse and the covariance of (u, v, a, b, ψ).
struct EllipseEstimate {
  Ellipse ellipse;
  Eigen::Matrix<double, 5, 5> covariance;
};

/// Maps a shape and the covariance of (u, v, Σ₁₁, Σ₁₂, Σ₂₂) to (u, v, a, b, ψ). The difference of
/// the axes is the length of a noisy vector, so it is freed of its Rice bias; the variance of ψ,
/// which knows no limit as a → b, is combined with that of a uniform angle.
EllipseEstimate estimate_of(const EllipseShape& shape,
                            const Eigen::Matrix<double, 5, 5>& covariance);

}  // namespace vigia::tracking
