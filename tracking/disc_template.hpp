#pragma once

#include "edge_fit.hpp"
#include "ellipse_shape.hpp"
#include "light_slope.hpp"

#include <bitset>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

#include "vigia/imaging/frame.hpp"

namespace vigia::tracking {

/// The model M of a disc for correlation: the share of the disc in each pixel of a rectangle, from
/// 0 (ground) to 1 (disc), with a blurred edge.
class DiscTemplate {
 public:
  /// Covers the ellipse and @p margin px round it.
  DiscTemplate(const EllipseShape& shape, double margin, double blur);

  /// Whether the template, moved by whole pixels, lies inside @p bounds.
  bool fits(int du, int dv, const imaging::Window& bounds) const;
  /// Armingol eq. 2: the correlation of the model, moved by whole pixels, with the image; 0 where
  /// the image is flat.
  double correlation(const vpImage<unsigned char>& image, int du, int dv) const;

  const imaging::Window& window() const { return window_; }

 private:
  imaging::Window window_;
  std::vector<float> model_;  ///< M − mean(M)
  double norm_ = 0.0;         ///< √Σ(M − mean)²
};

/// Armingol eq. 3, as a share.
double correlation_score(double r);

/// The best match near a start, r maximised over centre and shape.
struct TemplateMatch {
  bool converged = false;
  EllipseShape shape;
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Identity();
  double correlation = 0.0;  ///< r with the sign of the contrast
  double contrast = 0.0;     ///< ground minus disc, grey levels
  double ground = 0.0;       ///< grey level
  double noise = 0.0;        ///< grey levels
};

struct TemplateMatchParameters {
  double margin_px = 4.0;
  double blur_px = 0.75;
  int max_iterations = 12;  ///< of full steps, and of half steps after them where those swing
  /// What the fit of the outline has seen: a slope of light, which is taken out, and sectors of the
  /// outline that something covers, in which no pixel counts.
  std::optional<LightSlope> light;
  std::bitset<kOutlineSectors> covered;
};

/// Maximising r over the model's parameters is least squares with free gain and offset:
/// Gauss–Newton steps on (u, v, Σ, gain, offset), the model rendered anew each time. Reads only
/// inside
/// @p bounds.
TemplateMatch match_template(const vpImage<unsigned char>& image, const imaging::Window& bounds,
                             const EllipseShape& start, const TemplateMatchParameters& parameters);

}  // namespace vigia::tracking
