#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/ceiling_grid.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/patch_finder.hpp"

namespace vigia::tracking {

/// A window's grey values.
struct PatchWindow {
  imaging::Window window;
  std::vector<unsigned char> grey;

  unsigned char at(int u, int v) const {
    return grey[static_cast<std::size_t>(v - window.v) * static_cast<std::size_t>(window.width) +
                static_cast<std::size_t>(u - window.u)];
  }
};

/// Where and how a patch lies, and how it looks.
struct PatchShape {
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  double angle = 0.0;
  double log_scale = 0.0;  ///< of its size against what is expected
  double patch = 60.0;     ///< grey level
  double ground = 190.0;   ///< of the ceiling beside it
  double blur = 0.76;      ///< px
};

struct PatchFit {
  PatchShape shape;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (u, v, angle)
  double square = 0.0;  ///< Σ of the squared residuals, priors in it
  double noise = 0.0;   ///< rms of the residuals, with the degrees of freedom taken off
  double misfit = 0.0;  ///< rms of what neighbouring residuals share: no noise, but another shape
};

/// Fits the patch's shape, a body and its tongue with blurred edges, to the grey values about it by
/// Gauss–Newton; size and blur have priors. Nothing when it does not come to rest.
std::optional<PatchFit> fit_patch(const PatchWindow& window, const PatchShape& start,
                                  const PatchFinderParams& params);

}  // namespace vigia::tracking
