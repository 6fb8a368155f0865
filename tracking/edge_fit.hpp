#pragma once

#include "ellipse_shape.hpp"
#include "light_slope.hpp"
#include "outline_loops.hpp"

#include <array>
#include <bitset>
#include <optional>
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
  /// Whether to look beside the outline: a slope of light there is taken out of the fit. Pixels at
  /// 0 or 255 count as at least so dark or bright. And neighbours of sectors that disagree are left
  /// out with them: what covers a part of the outline seldom ends where a sector does.
  bool robust = false;
  /// Standard deviation of the blur about that of the start, px; 0: nothing is known of it.
  double blur_prior_px = 0.0;
  double noise = 0.0;  ///< of the picture, grey levels; 0: not known
};

/// Sectors of the outline, whose parts are tested one by one.
constexpr std::size_t kOutlineSectors = 24;

/// In which sector a point of the unit circle lies, by a substitute for the angle that needs no arc
/// tangent.
std::size_t outline_sector(float x, float y);

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
  double noise = 0.0;          ///< standard deviation of the residuals, grey levels
  double picture_noise = 0.0;  ///< what of that the picture explains, grey levels; 0: not known
  double raggedness = 0.0;  ///< rms distance of the sectors from the ellipse beyond the noise, px
  int bad_arcs = 0;         ///< runs of neighbouring sectors that disagree
  double agreement = 0.0;   ///< share of the outline's sectors that agree with the model
  bool complete = false;    ///< the whole band lay inside the bounds
  double clipped = 0.0;     ///< share of the band's pixels that are at 0 or 255
  double raggedness_chance = 0.0;            ///< what the picture's noise may add to it, px (3 σ)
  double ground_share = 1.0;                 ///< see Surroundings; 1 where nobody looked
  std::optional<LightSlope> light;           ///< that was taken out
  std::bitset<kOutlineSectors> bad_sectors;  ///< in UnitCoordinates of the shape
};

/// Maps an ellipse's points to the unit circle: Σ = L Lᵀ, (x, y) = L⁻¹ (u, v).
struct UnitCoordinates {
  double l11, l21, l22;
  explicit UnitCoordinates(const Eigen::Matrix2d& sigma);
};

/// Fits an ellipse with a blurred edge to the grey values in a band round its outline, by
/// Gauss–Newton on the model
///   g(x) = G − (G − D)·Φ((d(x) − κ s²/2)/s),
/// d the distance to the outline (positive inside), κ the outline's curvature, s the blur, D and G
/// the levels of disc and ground. The second term is the shift of a curved edge under blur; the
/// pixel's integration adds 1/12 px² to s². All eight quantities are estimated together, so that
/// the centre reaches the Cramér–Rao bound. Sectors of the outline that disagree are left out.
/// Under a slope of light, G and D are planes: their slopes are measured beside the band, which has
/// hardly any information of them that it doesn't need for the centre, and what is unsure of them
/// goes into the covariance.
class EdgeFitter {
 public:
  explicit EdgeFitter(const EdgeFitParameters& parameters = {}) : parameters_(parameters) {}

  void set_noise(double noise) { parameters_.noise = noise; }

  /// Reads only pixels of @p image inside @p bounds.
  EdgeFit fit(const vpImage<unsigned char>& image, const imaging::Window& bounds,
              const EllipseShape& start, const EdgeProfile& profile);
  /// The same from a start that is good but for sectors of the outline that something covers: those
  /// are left out from the beginning, before they can draw the ellipse away.
  EdgeFit fit_covered(const vpImage<unsigned char>& image, const imaging::Window& bounds,
                      const EllipseShape& start, const EdgeProfile& profile);

 private:
  static constexpr int kUnknowns = 8;
  // Columns of the Jacobian.
  static constexpr int kGround = 5;
  static constexpr int kContrast = 6;
  static constexpr int kBlur = 7;
  using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;

  /// Sums over the pixels of one sector of the outline.
  struct Sector {
    double square = 0.0;  ///< mean square of the residuals
    double edge = 0.0;    ///< Σ (∂g/∂d)²
    double pull = 0.0;    ///< Σ ∂g/∂d · residual
    int pixels = 0;
  };
  using Sectors = std::array<Sector, kOutlineSectors>;

  /// How the outline's sectors agree with the ellipse.
  struct Agreement {
    std::bitset<kOutlineSectors> bad;
    int bad_arcs = 0;
    double raggedness = 0.0;         ///< px
    double raggedness_chance = 0.0;  ///< px
    double unrest = 1.0;             ///< χ² per degree of freedom of the sectors' distances

    double share() const {
      return static_cast<double>(kOutlineSectors - bad.count()) /
             static_cast<double>(kOutlineSectors);
    }
  };

  void begin(const EllipseShape& start, const EdgeProfile& profile);
  void reserve(Eigen::Index capacity);
  void collect(const vpImage<unsigned char>& image, const imaging::Window& bounds);
  void leave_out_covered();
  void evaluate();
  void take_out_light();
  void expect_clipped();
  JacobianColumns columns();
  void project_residual();
  void accumulate();
  bool step();
  Sectors sum_sectors();
  Agreement judge_sectors(const Sectors& sectors) const;
  void keep_sectors(const std::bitset<kOutlineSectors>& bad);
  std::optional<Agreement> refine_without_bad(const vpImage<unsigned char>& image,
                                              const imaging::Window& bounds);
  double band_half_width() const;
  double picture_noise() const;
  void look_beside(const vpImage<unsigned char>& image, const imaging::Window& bounds);
  void expect_blur();
  EdgeFit finish(const vpImage<unsigned char>& image, const imaging::Window& bounds);
  bool settle(const vpImage<unsigned char>& image, const imaging::Window& bounds);
  bool iterate(const vpImage<unsigned char>& image, const imaging::Window& bounds);
  bool advance(const vpImage<unsigned char>& image, const imaging::Window& bounds);
  Eigen::Matrix<double, 5, 5> light_covariance(const Normal& inverse) const;
  EdgeFit conclude(const Agreement& agreement);

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
  double clipped_ = 0.0;                  ///< share of the band at 0 or 255
  double weight_ = 0.0;                   ///< of all pixels, one that isn't clipped having 1
  std::bitset<kOutlineSectors> covered_;  ///< sectors that are left out from the beginning
  Surroundings beside_;
  double start_blur_ = 0.0;

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
