#pragma once

#include "ellipse_shape.hpp"

#include <optional>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

#include "vigia/imaging/frame.hpp"

namespace vigia::tracking {

/// How the light falls off across a disc: the slopes of the grey level on the ground and on the
/// disc, levels per px, relative to a centre.
struct LightSlope {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d ground = Eigen::Vector2d::Zero();
  Eigen::Vector2d disc = Eigen::Vector2d::Zero();
  Eigen::Matrix2d ground_covariance = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d disc_covariance = Eigen::Matrix2d::Zero();
};

/// The levels on both sides of an outline.
struct SideLevels {
  double disc = 0.0;
  double ground = 0.0;
};

/// What lies beside an outline.
struct Surroundings {
  /// Share of the ring outside the band whose level is nearer to the ground's than to the disc's.
  double ground_share = 1.0;
  std::optional<LightSlope> light;
};

/// Measures what lies beside an outline, in a ring outside its band and on the disc within it, from
/// the mean levels of sectors. For the slope of light, sectors that stand out, as by a thing beside
/// the disc, are left out, and what is left of the others' scatter gives the covariance. A disc too
/// small for a slope of its own is taken to reflect the light that falls on the ground. There is no
/// slope when the ground shows none that stands clear of its scatter: two slopes more in a fit that
/// needs none would cost accuracy.
/// @p band_px: half width of the outline's band. Reads only inside @p bounds.
Surroundings measure_surroundings(const vpImage<unsigned char>& image,
                                  const imaging::Window& bounds, const EllipseShape& shape,
                                  double band_px, const SideLevels& levels);

}  // namespace vigia::tracking
