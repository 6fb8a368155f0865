#include "disc_finder.hpp"

#include "noise_smoothing.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::tracking {
namespace {

BlobFinderParameters blob_parameters(const DiscTrackerParameters& parameters) {
  BlobFinderParameters out;
  out.min_axis_px = parameters.min_axis_px;
  out.min_axis_ratio = parameters.min_axis_ratio;
  out.min_contrast = parameters.min_contrast;
  out.row_step = std::clamp(static_cast<int>(1.5 * parameters.min_axis_px), 1, 8);
  return out;
}

bool near(const EllipseShape& a, const EllipseShape& b) {
  const double size = std::sqrt(std::sqrt(b.sigma.determinant()));
  return (a.centre - b.centre).norm() < 0.5 * size;
}

}  // namespace

FeatureStatus judge_fit(const EdgeFit& fit, const DiscTrackerParameters& parameters) {
  if (!fit.converged) return FeatureStatus::wrong_object;
  const double contrast = std::abs(fit.profile.ground - fit.profile.disc);
  if (fit.agreement < parameters.min_occluded_agreement) return FeatureStatus::wrong_object;
  if (contrast < parameters.min_contrast || contrast < parameters.min_contrast_to_noise * fit.noise)
    return FeatureStatus::low_contrast;
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
  return feature;
}

DiscFinder::DiscFinder(const DiscTrackerParameters& parameters)
    : parameters_(parameters), blobs_(blob_parameters(parameters)) {}

std::vector<DiscCandidate> DiscFinder::find(const vpImage<unsigned char>& image,
                                            const imaging::Window& window, Polarity polarity,
                                            double min_axis_ratio) {
  std::vector<DiscCandidate> out;
  if (window.empty()) return out;
  smoothing_ = smoothing_for(noise_level(image, window), parameters_.min_contrast);
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
  find_blobs({smooth_, image, negative}, window, min_axis_ratio, out);
}

void DiscFinder::find_blobs(const Pictures& pictures, const imaging::Window& window,
                            double min_axis_ratio, std::vector<DiscCandidate>& out) {
  // Smoothing makes small ellipses of noise and of texture.
  constexpr double kSmoothings = 5.0;
  for (const Blob& blob : blobs_.find(pictures.blobs, window)) {
    const bool known = std::any_of(out.begin(), out.end(), [&](const DiscCandidate& other) {
      return other.status == FeatureStatus::found
                 ? near(blob.ellipse, other.fit.shape)
                 : other.blob.cut && blob.cut && near(blob.ellipse, other.blob.ellipse);
    });
    if (known) continue;
    DiscCandidate candidate;
    candidate.blob = blob;
    candidate.status = judge(candidate, pictures.pixels, window, min_axis_ratio);
    if (&pictures.blobs == &smooth_ && candidate.status == FeatureStatus::found &&
        ellipse_of(candidate.fit.shape).b < kSmoothings * smoothing_)
      candidate.status = FeatureStatus::wrong_object;
    if (pictures.negative) {
      EdgeProfile& profile = candidate.fit.profile;
      profile.disc = 255.0 - profile.disc;
      profile.ground = 255.0 - profile.ground;
    }
    out.push_back(candidate);
  }
}

FeatureStatus DiscFinder::judge(DiscCandidate& candidate, const vpImage<unsigned char>& image,
                                const imaging::Window& window, double min_axis_ratio) {
  const Blob& blob = candidate.blob;
  candidate.touches_window = blob.cut;
  if (blob.cut) return FeatureStatus::cut_by_border;
  const Ellipse ellipse = ellipse_of(blob.ellipse);
  if (ellipse.b < 0.8 * parameters_.min_axis_px || ellipse.b < min_axis_ratio * ellipse.a)
    return FeatureStatus::wrong_object;
  // A ragged outline of few pixels scatters the ratios.
  const double slack = 0.5 / ellipse.b;
  if (blob.fill < parameters_.min_fill - slack || blob.fill > parameters_.max_fill + slack ||
      blob.solidity < parameters_.min_solidity - slack ||
      blob.outline > parameters_.max_outline_px + parameters_.max_outline_ratio * ellipse.b)
    return FeatureStatus::wrong_object;

  candidate.fit = fitter_.fit(image, window, blob.ellipse, {blob.disc, blob.ground, 0.8});
  if (!candidate.fit.converged) return FeatureStatus::wrong_object;
  const Ellipse fitted = ellipse_of(candidate.fit.shape);
  const bool strayed =
      (candidate.fit.shape.centre - blob.ellipse.centre).norm() > 1.0 + 0.1 * ellipse.b ||
      std::abs(fitted.a - ellipse.a) > 1.0 + 0.15 * ellipse.a ||
      std::abs(fitted.b - ellipse.b) > 1.0 + 0.15 * ellipse.b;
  if (strayed || fitted.b < min_axis_ratio * fitted.a || fitted.b < parameters_.min_axis_px)
    return FeatureStatus::wrong_object;
  if (!candidate.fit.complete) {
    candidate.touches_window = true;
    return FeatureStatus::cut_by_border;
  }
  return judge_fit(candidate.fit, parameters_);
}

}  // namespace vigia::tracking
