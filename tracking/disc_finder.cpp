#include "disc_finder.hpp"

#include "covered_ellipse.hpp"
#include "noise_smoothing.hpp"
#include "pixel.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

BlobFinderParameters blob_parameters(const DiscTrackerParameters& parameters) {
  BlobFinderParameters out;
  out.min_axis_px = parameters.min_axis_px;
  out.min_axis_ratio = parameters.min_axis_ratio;
  out.min_contrast = parameters.min_contrast;
  out.row_step = std::clamp(static_cast<int>(1.5 * parameters.min_axis_px), 1, 8);
  out.keep_outlines = parameters.robust;
  return out;
}

// In strong noise the blur is taken from what lenses have.
EdgeFitParameters noise_fit_parameters(const DiscTrackerParameters& parameters) {
  EdgeFitParameters out = edge_fit_parameters(parameters);
  constexpr double kBlurSpread = 0.3;  // px
  out.blur_prior_px = parameters.robust ? kBlurSpread : 0.0;
  return out;
}

// What the picture's noise leaves unexplained of the residuals.
double misfit_of(const EdgeFit& fit) {
  return std::sqrt(std::max(0.0, std::pow(fit.noise, 2) - std::pow(fit.picture_noise, 2)));
}

// Whether a fit stands clear of the picture's noise as a whole: C √(pixels)/σ. A large disc is seen
// in noise in which a small one is not.
bool stands_clear_of_noise(const EdgeFit& fit) {
  constexpr double kClear = 30.0;
  constexpr double kLeastRatio = 1.5;
  const double contrast = std::abs(fit.profile.ground - fit.profile.disc);
  const double pixels = kPi * std::sqrt(fit.shape.sigma.determinant());
  return contrast >= kLeastRatio * fit.noise && contrast * std::sqrt(pixels) >= kClear * fit.noise;
}

FeatureStatus judge_robustly(const EdgeFit& fit, const DiscTrackerParameters& parameters) {
  constexpr int kCoveredArcs = 2;
  constexpr double kLargeEnough = 5.0;  // px: of a smaller disc a part may be any blot
  constexpr double kLeastGround = 0.6;  // of the ring beside the outline
  constexpr double kRound = 0.04;       // of the semi-minor axis
  const double axis = ellipse_of(fit.shape).b;
  const double ragged = std::min(
      parameters.max_raggedness_px + parameters.max_raggedness_ratio * axis, kRound * axis);
  if (fit.raggedness > std::hypot(ragged, fit.raggedness_chance) || fit.ground_share < kLeastGround)
    return FeatureStatus::wrong_object;
  if (fit.agreement >= parameters.min_agreement) return FeatureStatus::found;
  if (fit.bad_arcs > kCoveredArcs || axis < kLargeEnough) return FeatureStatus::wrong_object;
  return fit.agreement >= parameters.min_visible ? FeatureStatus::found : FeatureStatus::occluded;
}

bool near(const EllipseShape& a, const EllipseShape& b) {
  const double size = std::sqrt(std::sqrt(b.sigma.determinant()));
  return (a.centre - b.centre).norm() < 0.5 * size;
}

}  // namespace

EdgeFitParameters edge_fit_parameters(const DiscTrackerParameters& parameters) {
  EdgeFitParameters out;
  if (!parameters.robust) return out;
  out.robust = true;
  return out;
}

FeatureStatus judge_fit(const EdgeFit& fit, const DiscTrackerParameters& parameters) {
  if (!fit.converged) return FeatureStatus::wrong_object;
  const double contrast = std::abs(fit.profile.ground - fit.profile.disc);
  if (fit.agreement < parameters.min_occluded_agreement) return FeatureStatus::wrong_object;
  const bool clear = contrast >= parameters.min_contrast_to_noise * fit.noise ||
                     (parameters.robust && stands_clear_of_noise(fit) &&
                      contrast >= parameters.min_contrast_to_noise * misfit_of(fit));
  if (contrast < parameters.min_contrast || !clear) return FeatureStatus::low_contrast;
  if (parameters.robust) return judge_robustly(fit, parameters);
  // What hides a disc takes an arc or two of the outline; another form crosses the ellipse often.
  constexpr int kOccludedArcs = 2;
  if (fit.agreement < parameters.min_agreement)
    return fit.bad_arcs <= kOccludedArcs ? FeatureStatus::occluded : FeatureStatus::wrong_object;
  const double ragged =
      parameters.max_raggedness_px + parameters.max_raggedness_ratio * ellipse_of(fit.shape).b;
  return fit.raggedness > ragged ? FeatureStatus::wrong_object : FeatureStatus::found;
}

EllipseFeature feature_of(const EdgeFit& fit, FeatureStatus status) {
  EllipseFeature feature;
  feature.status = status;
  if (!fit.converged) return feature;
  const EllipseEstimate estimate = estimate_of(fit.shape, fit.covariance);
  feature.ellipse = estimate.ellipse;
  feature.covariance = estimate.covariance;
  feature.contrast = fit.profile.ground - fit.profile.disc;
  // 1 for a clean outline, less for sectors that disagree and for raggedness.
  feature.score = fit.agreement / (1.0 + fit.raggedness);
  feature.visible = fit.agreement;
  feature.clipped = fit.clipped;
  return feature;
}

DiscFinder::DiscFinder(const DiscTrackerParameters& parameters)
    : parameters_(parameters),
      blobs_(blob_parameters(parameters)),
      fitter_(edge_fit_parameters(parameters)),
      noise_fitter_(noise_fit_parameters(parameters)) {}

std::vector<DiscCandidate> DiscFinder::find(const vpImage<unsigned char>& image,
                                            const imaging::Window& window, Polarity polarity,
                                            double min_axis_ratio) {
  std::vector<DiscCandidate> out;
  if (window.empty()) return out;
  noise_ = noise_level(image, window);
  fitter_.set_noise(noise_);
  noise_fitter_.set_noise(noise_);
  smoothing_ = smoothing_for(noise_, parameters_.min_contrast);
  if (polarity != Polarity::bright) find_dark(image, window, false, min_axis_ratio, out);
  if (polarity != Polarity::dark) {
    negative_.resize(image.getHeight(), image.getWidth());
    for (int v = window.v; v < window.bottom(); ++v) {
      const unsigned char* from = image[static_cast<unsigned>(v)] + window.u;
      unsigned char* to = negative_[static_cast<unsigned>(v)] + window.u;
      for (int u = 0; u < window.width; ++u) to[u] = static_cast<unsigned char>(255 - from[u]);
    }
    find_dark(negative_, window, true, min_axis_ratio, out);
  }
  return out;
}

void DiscFinder::find_dark(const vpImage<unsigned char>& image, const imaging::Window& window,
                           bool negative, double min_axis_ratio, std::vector<DiscCandidate>& out) {
  blobs_.set_min_axis_ratio(min_axis_ratio);
  find_blobs({image, image, negative}, window, min_axis_ratio, out);
  if (smoothing_ == 0.0) return;
  smooth(image, window, smoothing_, smooth_);
  find_blobs({smooth_, image, negative, smoothing_}, window, min_axis_ratio, out);
  if (parameters_.robust) find_in_half_size(image, window, negative, min_axis_ratio, out);
}

// Half the size, half the noise, and edges half as wide: what strong noise has left of the steps
// between pixels stands out again.
void DiscFinder::find_in_half_size(const vpImage<unsigned char>& image,
                                   const imaging::Window& window, bool negative,
                                   double min_axis_ratio, std::vector<DiscCandidate>& out) {
  constexpr double kStrong = 2.0;  // times the noise that is smoothed at all
  const double again = smoothing_for(0.5 * noise_, parameters_.min_contrast);
  if (smoothing_for(noise_ / kStrong, parameters_.min_contrast) == 0.0) return;
  vpImage<unsigned char> half = halved(image, window);
  const imaging::Window whole{0, 0, static_cast<int>(half.getWidth()),
                              static_cast<int>(half.getHeight())};
  if (whole.width < 8 || whole.height < 8) return;
  if (again > 0.0) {
    vpImage<unsigned char> soft;
    smooth(half, whole, again, soft);
    half = soft;
  }
  find_blobs({half, image, negative, std::max(2.0 * again, 1.0), 2}, window, min_axis_ratio, out);
}

void DiscFinder::find_blobs(const Pictures& pictures, const imaging::Window& window,
                            double min_axis_ratio, std::vector<DiscCandidate>& out) {
  // Smoothing makes small ellipses of noise and of texture.
  const double smoothings = parameters_.robust ? 3.0 : 5.0;
  const imaging::Window searched =
      pictures.scale == 1 ? window
                          : imaging::Window{0, 0, static_cast<int>(pictures.blobs.getWidth()),
                                            static_cast<int>(pictures.blobs.getHeight())};
  for (const Blob& found : blobs_.find(pictures.blobs, searched)) {
    const Blob blob = pictures.scale == 1 ? found : doubled(found, window);
    const bool known = std::any_of(out.begin(), out.end(), [&](const DiscCandidate& other) {
      return other.status == FeatureStatus::found
                 ? near(blob.ellipse, other.fit.shape)
                 : other.blob.cut && blob.cut && near(blob.ellipse, other.blob.ellipse);
    });
    if (known) continue;
    DiscCandidate candidate;
    candidate.blob = blob;
    candidate.status = judge(candidate, pictures, window, min_axis_ratio);
    if (pictures.smoothing > 0.0 && candidate.status == FeatureStatus::found &&
        ellipse_of(candidate.fit.shape).b < smoothings * pictures.smoothing)
      candidate.status = FeatureStatus::wrong_object;
    if (pictures.negative) {
      EdgeProfile& profile = candidate.fit.profile;
      profile.disc = 255.0 - profile.disc;
      profile.ground = 255.0 - profile.ground;
    }
    out.push_back(candidate);
  }
}

// The tests of a blob's form, before anything is fitted.
bool DiscFinder::has_form(const Blob& blob, const Pictures& pictures) const {
  // A ragged outline of few pixels scatters the ratios.
  const double b = ellipse_of(blob.ellipse).b;
  const double slack = 0.5 * pictures.scale / b;
  // What is left of strong noise wrinkles the outline.
  const double wrinkles = parameters_.robust && pictures.smoothing > 0.0 ? 0.4 : 0.0;
  return blob.fill >= parameters_.min_fill - slack && blob.fill <= parameters_.max_fill + slack &&
         blob.solidity >= parameters_.min_solidity - slack &&
         blob.outline <= (parameters_.max_outline_px + wrinkles) * pictures.scale +
                             parameters_.max_outline_ratio * b;
}

EdgeFitter& DiscFinder::fitter_for(const Pictures& pictures) {
  return pictures.smoothing > 0.0 ? noise_fitter_ : fitter_;
}

FeatureStatus DiscFinder::judge(DiscCandidate& candidate, const Pictures& pictures,
                                const imaging::Window& window, double min_axis_ratio) {
  const Blob& blob = candidate.blob;
  candidate.touches_window = blob.cut;
  if (blob.cut) return FeatureStatus::cut_by_border;
  const Ellipse ellipse = ellipse_of(blob.ellipse);
  if (ellipse.b < 0.8 * parameters_.min_axis_px || ellipse.b < min_axis_ratio * ellipse.a)
    return FeatureStatus::wrong_object;
  FeatureStatus status = FeatureStatus::wrong_object;
  const EdgeProfile profile{blob.disc, blob.ground, kStartBlur};
  if (has_form(blob, pictures)) {
    candidate.fit = fitter_for(pictures).fit(pictures.pixels, window, blob.ellipse, profile);
    status = judge_outline(candidate, pictures, blob.ellipse, min_axis_ratio);
  }
  if (status == FeatureStatus::found || !parameters_.robust) return status;
  const auto covered = covered_ellipse(blob);
  if (!covered) return status;
  candidate.fit = fitter_for(pictures).fit_covered(pictures.pixels, window, *covered, profile);
  return judge_outline(candidate, pictures, *covered, min_axis_ratio);
}

FeatureStatus DiscFinder::judge_outline(DiscCandidate& candidate, const Pictures& pictures,
                                        const EllipseShape& start, double min_axis_ratio) {
  if (!candidate.fit.converged) return FeatureStatus::wrong_object;
  const Ellipse ellipse = ellipse_of(start);
  const Ellipse fitted = ellipse_of(candidate.fit.shape);
  const double room = pictures.scale;
  const bool strayed =
      (candidate.fit.shape.centre - start.centre).norm() > room + 0.1 * ellipse.b ||
      std::abs(fitted.a - ellipse.a) > room + 0.15 * ellipse.a ||
      std::abs(fitted.b - ellipse.b) > room + 0.15 * ellipse.b;
  if (strayed || fitted.b < min_axis_ratio * fitted.a || fitted.b < parameters_.min_axis_px)
    return FeatureStatus::wrong_object;
  if (!candidate.fit.complete) {
    candidate.touches_window = true;
    return FeatureStatus::cut_by_border;
  }
  return judge_fit(candidate.fit, parameters_);
}

}  // namespace vigia::tracking
