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

/// Finds discs in a window without knowing where: blobs, tests of their form, then the fit of the
/// outline. Bright discs are looked for in the negative. Where the pixels' noise would break up the
/// blobs, they are looked for in a smoothed copy as well; the fit reads the pixels as they are, so
/// that its covariance stays true.
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
  };

  void find_dark(const vpImage<unsigned char>& image, const imaging::Window& window, bool negative,
                 double min_axis_ratio, std::vector<DiscCandidate>& out);
  void find_blobs(const Pictures& pictures, const imaging::Window& window, double min_axis_ratio,
                  std::vector<DiscCandidate>& out);
  FeatureStatus judge(DiscCandidate& candidate, const vpImage<unsigned char>& image,
                      const imaging::Window& window, double min_axis_ratio);

  DiscTrackerParameters parameters_;
  BlobFinder blobs_;
  EdgeFitter fitter_;
  vpImage<unsigned char> negative_;
  vpImage<unsigned char> smooth_;
  double smoothing_ = 0.0;  ///< standard deviation of the window's smoothing, px; 0: none
};

/// Whether a fit of an outline passes for a disc: found, occluded, low_contrast or wrong_object.
FeatureStatus judge_fit(const EdgeFit& fit, const DiscTrackerParameters& parameters);

/// The feature of a fit.
EllipseFeature feature_of(const EdgeFit& fit, FeatureStatus status);

}  // namespace vigia::tracking
