#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {

struct EdgeFlowParams {
  double blur_px = 1.2;  ///< σ of the smoothing before edges are sought
  double low = 15.0;     ///< Canny's thresholds on Sobel's slope
  double high = 40.0;
  int max_shift_px = 8;  ///< half the window of shifts, in u and in v
  double max_turn = from_deg(1.0);
  double turn_step = from_deg(0.1);
};

/// The edges of a frame: an image of them, and the array of Chonbuk's fig. 6.
struct EdgeImage {
  int width = 0;
  int height = 0;
  std::vector<unsigned char> edge;     ///< 1 on an edge, row by row
  std::vector<Eigen::Vector2i> array;  ///< (u, v) of each edge pixel
};

EdgeImage find_edges(const vpImage<unsigned char>& image, const EdgeFlowParams& params = {});

/// How the picture moved between two frames: m' = R(turn) m + shift, m from the image's middle.
struct EdgeMatch {
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();
  double turn = 0.0;        ///< from u towards v
  int matched = 0;          ///< edge pixels of the first frame that meet one of the second
  double lost_share = 0.0;  ///< of them that leave the picture
};

/// Chonbuk eqs. 6 and 8, argmax: the turn and the whole-pixel shift in the window about
/// @p expected under which most edge pixels meet edge pixels. Rotation is about the image's middle
/// with the full matrix, which eq. 6 misprints.
EdgeMatch match_edges(const EdgeImage& before, const EdgeImage& after,
                      const EdgeFlowParams& params = {}, const EdgeMatch& expected = {});

}  // namespace vigia::tracking
