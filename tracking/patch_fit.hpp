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

/// How the light changes along a patch.
struct PatchLight {
  Eigen::Vector2d pivot = Eigen::Vector2d::Zero();  ///< where the levels hold, px
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< of the ground, grey levels on 10 px
  double gain = 0.5;  ///< how much of the slope is gain rather than light that is added
};

/// Where and how a patch lies, and how it looks.
struct PatchShape {
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  double angle = 0.0;
  double log_scale = 0.0;  ///< of its size against what is expected
  double patch = 60.0;     ///< grey level
  double ground = 190.0;   ///< of the ceiling beside it
  double blur = 0.76;      ///< px
  double gamma = 1.0;      ///< power of the grey values that is linear in light
  PatchLight light;
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< while it was exposed, px
};

constexpr int kFitUnknowns = 7;  ///< u, v, angle, log scale, patch, ground, blur
constexpr double kBlurSigma_px = 0.3;
constexpr double kMinNoise = 0.3;  ///< grey levels

/// The shape moved by a step of those unknowns, which is kept within bounds.
PatchShape stepped(const PatchShape& shape, const Eigen::Matrix<double, kFitUnknowns, 1>& step);

struct PatchFit {
  PatchShape shape;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (u, v, angle)
  double square = 0.0;  ///< Σ of the squared residuals, priors in it
  double noise = 0.0;   ///< rms of the residuals, with the degrees of freedom taken off
  double misfit = 0.0;  ///< rms of what neighbouring residuals share: no noise, but another shape
  /// What its edges, blurred more in one direction, suggest of a motion.
  Eigen::Vector2d suspected_motion = Eigen::Vector2d::Zero();
};

/// Fits the patch's shape, a body and its tongue with blurred edges under even light, to the grey
/// values about it by Gauss–Newton; size and blur have priors. Nothing when it does not come to
/// rest; left as it is where after two steps its square is still more than @p give_up. Covariance
/// and misfit are refine_patch()'s.
std::optional<PatchFit> fit_patch(const PatchWindow& window, const PatchShape& start,
                                  const PatchFinderParams& params, double give_up);

/// States the covariance and the misfit, and fits once more with what even light and a linear
/// camera leave out, where the grey values show it: the response's power, and light that changes
/// along the patch; a motion is suspected only. Of a patch that is not @p whole all are left out.
/// Nothing when that goes astray.
std::optional<PatchFit> refine_patch(const PatchWindow& window, const PatchFinderParams& params,
                                     bool whole, PatchFit fit);

/// The same of a patch that moved while it was exposed, from a start that is near, its motion
/// included: the mean of its images along it.
std::optional<PatchFit> fit_moved(const PatchWindow& window, const PatchFinderParams& params,
                                  const PatchShape& start);

}  // namespace vigia::tracking
