#pragma once

#include <Eigen/Core>

namespace vigia {

/// The image of one ceiling patch. Which patch of the grid it is, the image does not say.
struct PatchImage {
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();  ///< image of its middle, px
  double angle = 0.0;                            ///< of its forward direction, from u towards v
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (u, v, angle)
  /// Log-odds of the forward end being where angle has it against half a turn from there; 0 where
  /// patches have no polarity mark.
  double forward_log_odds = 0.0;
  bool cut = false;  ///< by the image's border: its covariance says what it still tells
};

}  // namespace vigia
