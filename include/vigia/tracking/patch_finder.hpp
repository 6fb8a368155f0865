#pragma once

#include <vector>

#include "vigia/core/patch_image.hpp"
#include "vigia/imaging/frame.hpp"

namespace vigia::tracking {

struct PatchFinderParams {
  double length_px = 22.7;  ///< of a patch's image, tongue and all
  double width_px = 7.6;
  bool polarity = true;          ///< whether the forward end is drawn in to a tongue
  double scale_sigma = 0.03;     ///< of the image's size, relative
  double max_scale_error = 0.1;  ///< a patch of another size is none
  double blur_px = 0.76;  ///< σ of an edge, the pixel's own share in it, where the fit begins
  /// Of the ceiling's grey level beside it, that a patch is darker at least: what its paint makes
  /// of any light.
  double min_contrast = 0.22;
  double enough_contrast = 40.0;  ///< grey levels: so much is in any light
  double least_contrast = 10.0;   ///< … and less is in none
  double contrast_to_noise = 5.0;
  /// Rms of the fit's residuals by the contrast, at most; of what neighbours share in them, by so
  /// much less as the edges are blurred more than expected.
  double max_misfit = 0.12;
  double max_noise = 12.0;  ///< … or this, grey levels, of a patch of enough contrast
};

/// What a frame shows of a patched ceiling.
struct PatchScan {
  std::vector<PatchImage> patches;
  int rejected = 0;    ///< dark spots that are no patches
  double noise = 0.0;  ///< rms of the fits' residuals, grey levels; 0 without patches
};

/// Finds all patches of a frame. Rows so close together that no patch lies between them are scanned
/// for dark chords; round each, a window is read, filled at half contrast, and the patch's blurred
/// shape fitted to its grey values, which reaches the Cramér–Rao bound of place and direction. Of a
/// patch that the border cuts, the size that is expected stands for the end that is not seen. What
/// is a patch only if it moved while it was exposed is one where another of the frame moved alike.
/// Only the rows and windows are read.
class PatchFinder {
 public:
  explicit PatchFinder(const PatchFinderParams& params = {}) : params_(params) {}

  PatchScan find(const imaging::Frame& frame) const;

 private:
  PatchFinderParams params_;
};

}  // namespace vigia::tracking
