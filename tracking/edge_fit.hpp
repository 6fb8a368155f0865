#pragma once

#include "ellipse_shape.hpp"
#include "outline_loops.hpp"

#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

#include "vigia/imaging/frame.hpp"

namespace vigia::tracking {

/// How an outline is fitted to grey values.
struct EdgeFitParameters {
  /// Half width of the fitted band round the outline, in standard deviations of the edge's blur.
  double band_blurs = 2.5;
  int max_iterations = 8;
  /// A longer band is thinned out to about so many pixels.
  int max_pixels = 1500;
  /// Below this share of agreeing sectors the fit is given up.
  double min_agreement = 0.3;
  /// A sector of the outline disagrees when its residual's rms is above both of these: a multiple
  /// of the median sector's, and a fraction of the contrast.
  double sector_noise_ratio = 3.0;
  double sector_contrast_ratio = 0.2;
  /// It disagrees as well when it lies off the ellipse by more than so many px or this share of the
  /// semi-minor axis, whichever is more, and by this multiple of its standard deviation.
  double sector_offset_px = 0.35;
  double sector_offset_ratio = 0.03;
  double sector_offset_sigmas = 4.0;
};

/// Grey levels on both sides of an outline and the standard deviation of its blur in px, with the
/// pixel's own integration.
struct EdgeProfile {
  double disc = 50.0;
  double ground = 200.0;
  double blur = 0.8;
};

struct EdgeFit {
  /// Whether the iteration came to rest on an ellipse. Nothing else here counts if not.
  bool converged = false;
  EllipseShape shape;
  /// Of (u, v, Σ₁₁, Σ₁₂, Σ₂₂).
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Identity();
  EdgeProfile profile;
  double noise = 0.0;       ///< standard deviation of the residuals, grey levels
  double raggedness = 0.0;  ///< rms distance of the sectors from the ellipse beyond the noise, px
  int bad_arcs = 0;         ///< runs of neighbouring sectors that disagree
  double agreement = 0.0;   ///< share of the outline's sectors that agree with the model
  bool complete = false;    ///< the whole band lay inside the bounds
};

/// Fits an ellipse with a blurred edge to the grey values in a band round its outline, by
/// Gauss–Newton on the model
///   g(x) = G − (G − D)·Φ((d(x) − κ s²/2)/s),
/// d the distance to the outline (positive inside), κ the outline's curvature, s the blur, D and G
/// the levels of disc and ground. The second term is the shift of a curved edge under blur; the
/// pixel's integration adds 1/12 px² to s². All eight quantities are estimated together, so that
/// the centre reaches the Cramér–Rao bound. Sectors of the outline that disagree are left out.
class EdgeFitter {
 public:
  explicit EdgeFitter(const EdgeFitParameters& parameters = {}) : parameters_(parameters) {}

  /// Reads only pixels of @p image inside @p bounds.
  EdgeFit fit(const vpImage<unsigned char>& image, const imaging::Window& bounds,
              const EllipseShape& start, const EdgeProfile& profile);

 private:
  static constexpr int kUnknowns = 8;
  // Columns of the Jacobian.
  static constexpr int kGround = 5;
  static constexpr int kContrast = 6;
  static constexpr int kSectors = 24;
  using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;

  void collect(const vpImage<unsigned char>& image, const imaging::Window& bounds);
  void evaluate();
  JacobianColumns columns();
  void project_residual();
  void accumulate();
  bool step();
  double drop_bad_sectors(double& raggedness);
  bool iterate(const vpImage<unsigned char>& image, const imaging::Window& bounds);
  bool advance(const vpImage<unsigned char>& image, const imaging::Window& bounds);

  EdgeFitParameters parameters_;

  // The state of the fit, and the ellipse and blur for which the band was collected.
  EllipseShape shape_;
  EdgeProfile profile_;
  EllipseShape band_shape_;
  double band_blur_ = 0.0;
  double damping_ = 1.0;       ///< share of a full step that is taken
  double change_ = 0.0;        ///< of outline and blur by the last step, px
  double level_change_ = 0.0;  ///< of the grey levels by the last step, as a share of the contrast
  bool complete_ = false;
  int bad_arcs_ = 0;
  double unrest_ = 1.0;  ///< χ² per degree of freedom of the sectors' distances

  Normal normal_;
  Vector gradient_;

  // One column a quantity, one row a pixel of the band.
  int count_ = 0;
  Eigen::ArrayXf u_, v_, grey_, residual_, t_;
  Eigen::ArrayXXf work_;
  Eigen::Array<float, Eigen::Dynamic, kUnknowns> jacobian_;
  std::vector<unsigned char> sector_;
};

}  // namespace vigia::tracking
