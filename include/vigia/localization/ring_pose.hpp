#pragma once

#include <array>
#include <optional>

#include "vigia/core/colour_pattern.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/localization/view_parameters.hpp"

namespace vigia::localization {

/// Which of the pattern's rings a closed form reads.
enum class Ring { outer, inner };

/// as_published: Adán eq. 10–12 (R sin φ ≪ D), θ by eq. 16–17 with the signs mended; the branch of
/// ψ is the one of a camera below the pattern (|θ| ≤ 90°). exact: the perspective of the circle
/// inverted, the branch of ψ by the offset of the ellipse's centre from the centre-point where that
/// was seen.
enum class RingMethod { as_published, exact };

struct RingPoseParams {
  Ring ring = Ring::outer;
  RingMethod method = RingMethod::exact;
  /// Turn the image about the optical centre so that the centre-point lies on the axis. Without it
  /// the method takes for granted that it does (the QUIXOTE assumption).
  bool centre_view = true;
  double frontal_below = 0.4363323129985824;  ///< φ under which a view counts as frontal: 25°
  double ambiguity_ratio = 20.0;  ///< the twin is as good unless so many times less likely
};

/// A ring's ellipse and its axis points, normalised coordinates with x left and y up from the
/// optical axis, turned by ψ (the primes of eq. 3–7).
struct RingImage {
  double a = 0.0;  ///< long semi-axis
  double b = 0.0;
  double psi = 0.0;                                  ///< the branch in (−π/2, π/2]
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< (x'_c, y'_c)
  std::array<Eigen::Vector2d, kDotsPerRing> points;  ///< first to eighth
};

/// The conic through eight points (eq. 1, about their mean and scaled: with F = −1 the origin must
/// lie inside), its ψ = ½ atan2(−B, C−A) and its axes (eq. 3–7). Nothing unless it is an ellipse.
std::optional<RingImage> fit_ring(const std::array<Eigen::Vector2d, kDotsPerRing>& points);

struct RingPose {
  ViewParameters view;
  Eigen::Isometry3d cMl;
  bool frontal = false;       ///< φ is small: φ and θ are poorly determined
  bool twin_as_good = false;  ///< the image hardly tells the view from its twin (see twin_of())
};

/// Adán's method on the eight dots of one ring. Nothing when a dot of the ring (or the centre-point
/// that centre_view needs) was not seen or the dots lie on no ellipse.
std::optional<RingPose> ring_pose(const PatternShape& shape, const PointsObservation& observation,
                                  const RingPoseParams& params);

}  // namespace vigia::localization
