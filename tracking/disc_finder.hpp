#pragma once

#include "blob_finder.hpp"
#include "edge_fit.hpp"

#include <vector>

#include "vigia/tracking/disc_tracker.hpp"

namespace vigia::tracking {

/// A blob, judged.
struct DiscCandidate {
  FeatureStatus status = FeatureStatus::wrong_object;
  Blob blob;
  EdgeFit fit;  ///< converged when status is found
  bool touches_window = false;
};

/// How a tracker's discs are fitted.
EdgeFitParameters edge_fit_parameters(const DiscTrackerParameters& parameters);

/// Finds discs in a window without knowing where: blobs, tests of their form, then the fit of the
/// outline. Bright discs are looked for in the negative. Where the pixels' noise would break up the
/// blobs, they are looked for in a smoothed copy as well, and in strong noise in one of half the
/// size; the fit reads the pixels as they are, so that its covariance stays true.
class DiscFinder {
 public:
  explicit DiscFinder(const DiscTrackerParameters& parameters);

  /// Every blob in the window with its judgement. @p min_axis_ratio: flatter blobs are no discs.
  std::vector<DiscCandidate> find(const vpImage<unsigned char>& image,
                                  const imaging::Window& window, Polarity polarity,
                                  double min_axis_ratio);

 private:
  /// Where dark blobs are looked for, and in which pixels their outlines are fitted.
  struct Pictures {
    const vpImage<unsigned char>& blobs;
    const vpImage<unsigned char>& pixels;
    bool negative;
    double smoothing = 0.0;  ///< of the blobs' picture, px of the pixels'; 0: none
    int scale = 1;           ///< pixels to a pixel of the blobs' picture
  };

  void find_dark(const vpImage<unsigned char>& image, const imaging::Window& window, bool negative,
                 double min_axis_ratio, std::vector<DiscCandidate>& out);
  void find_in_half_size(const vpImage<unsigned char>& image, const imaging::Window& window,
                         bool negative, double min_axis_ratio, std::vector<DiscCandidate>& out);
  void find_blobs(const Pictures& pictures, const imaging::Window& window, double min_axis_ratio,
                  std::vector<DiscCandidate>& out);
  FeatureStatus judge(DiscCandidate& candidate, const Pictures& pictures,
                      const imaging::Window& window, double min_axis_ratio);
  bool has_form(const Blob& blob, const Pictures& pictures) const;
  FeatureStatus judge_outline(DiscCandidate& candidate, const Pictures& pictures,
                              const EllipseShape& start, double min_axis_ratio);
  EdgeFitter& fitter_for(const Pictures& pictures);

  DiscTrackerParameters parameters_;
  BlobFinder blobs_;
  EdgeFitter fitter_;
  EdgeFitter noise_fitter_;  ///< knows the blur beforehand, which noise hardly lets it see
  vpImage<unsigned char> negative_;
  vpImage<unsigned char> smooth_;
  double noise_ = 0.0;      ///< of the window, grey levels
  double smoothing_ = 0.0;  ///< standard deviation of the window's smoothing, px; 0: none
};

/// Whether a fit of an outline passes for a disc: found, occluded, low_contrast or wrong_object.
FeatureStatus judge_fit(const EdgeFit& fit, const DiscTrackerParameters& parameters);

/// The feature of a fit.
EllipseFeature feature_of(const EdgeFit& fit, FeatureStatus status);

}  // namespace vigia::tracking
