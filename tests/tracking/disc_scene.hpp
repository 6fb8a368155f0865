#pragma once

#include "synthetic_image.hpp"

#include <cmath>

#include "vigia/core/random.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"

namespace vigia::tracking::testing {

/// One disc on plain ground, as the reference figures have it: contrast 150, noise 4, blur 0.7 px.
struct DiscScene {
  int width = 100;
  int height = 100;
  double ground = 200.0;
  double contrast = 150.0;
  double noise = 4.0;
  double blur = 0.7;
  int fine = 3;  ///< of the grid on which the disc is rendered

  imaging::ImageFrame expose(const Ellipse& disc, RandomStream& random) const {
    SyntheticImage image(width, height, ground, blur, fine);
    image.paint_ellipse(disc, ground - contrast);
    return imaging::ImageFrame(image.expose(noise, random));
  }
};

inline imaging::Canvas canvas_of(const imaging::Frame& frame) {
  imaging::Canvas canvas;
  canvas.attach(frame);
  return canvas;
}

/// The bound of a circle's centre per axis (LIBRARIES.md), with the noise of rounding to whole
/// grey levels.
inline double centre_bound(double radius, double contrast, double noise, double blur) {
  const double sigma = std::sqrt(noise * noise + 1.0 / 12.0);
  const double s_b = std::sqrt(blur * blur + 1.0 / 12.0);
  return sigma / contrast * std::sqrt(2.0 * s_b / (std::sqrt(3.14159265358979323846) * radius));
}

/// A prediction that is off by some pixels and says so.
inline EllipsePrediction prediction_near(const Ellipse& disc, double sigma_px,
                                         RandomStream& random) {
  EllipsePrediction prediction;
  prediction.ellipse = disc;
  // Two standard deviations at most: inside every gate.
  prediction.ellipse.u += sigma_px * random.uniform(-2.0, 2.0);
  prediction.ellipse.v += sigma_px * random.uniform(-2.0, 2.0);
  prediction.ellipse.a *= 1.04;
  prediction.ellipse.b *= 1.04;
  prediction.centre_covariance = Eigen::Matrix2d::Identity() * sigma_px * sigma_px;
  prediction.scale_sigma = 0.05;
  return prediction;
}

}  // namespace vigia::tracking::testing
