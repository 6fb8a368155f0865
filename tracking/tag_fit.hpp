#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

namespace vigia::tracking {

/// A tag as printed: square fields, row by row from the top, with what lies round its border.
struct TagGrid {
  int fields = 0;                   ///< across, everything included
  int border = 0;                   ///< across, from corner to corner of the border
  double sure = 0.0;                ///< half the width, in fields, of what is known to be printed
  std::vector<std::uint8_t> white;  ///< 1: white, 0: black

  bool is_white(int column, int row) const {
    const int field = row * fields + column;
    return white[static_cast<std::size_t>(field)] != 0;
  }
};

using TagCorners = std::array<Eigen::Vector2d, 4>;

enum class TagFitStatus {
  fitted,
  lost,     ///< the fit came to no rest, or there is too little contrast or too few pixels
  covered,  ///< part of the border or too many fields disagree with the print
};

struct TagFit {
  TagFitStatus status = TagFitStatus::lost;
  TagCorners corners;  ///< px
  std::array<Eigen::Matrix2d, 4> covariance;
  double blur = 0.8;      ///< σ, with the pixel's own integration, px
  double contrast = 0.0;  ///< grey levels
  double noise = 0.0;     ///< of the residuals, grey levels
  double tone = 0.0;      ///< κ below
  int bad_fields = 0;     ///< that disagree with the print
};

struct TagFitParams {
  double start_blur = 0.8;  ///< px
  int max_iterations = 12;
  int max_pixels = 6000;       ///< more are thinned out
  int max_bad_fields = 1;      ///< inside the border
  double min_contrast = 15.0;  ///< grey levels
  double min_contrast_to_noise = 2.0;
};

/// Fits the whole tag to the grey values by Gauss–Newton, from corners that are right to a pixel or
/// two, in the order lower left, lower right, upper right, upper left as the tag's reader sees
/// them. The model is
///   g(x) = (D + C·τ(T))·(1 + a·x),  τ(T) = T + κ T (1 − T),
/// T the print (0 black, 1 white) seen through a homography and blurred by a Gaussian: the eight
/// unknowns of the homography, the levels D and C, the slope a of the light, the blur, and κ, which
/// stands for a camera's response after the blur and for ink that spreads; both move all edges from
/// black to white alike, and the sides alone could not tell them from the tag's size. Fields that
/// disagree with the print are left out; where such a field is one of the border's, the tag is
/// covered. Reads only pixels within the tag and its certain rim.
TagFit fit_tag(const vpImage<unsigned char>& image, const TagGrid& grid, const TagCorners& corners,
               const TagFitParams& params = {});

}  // namespace vigia::tracking
