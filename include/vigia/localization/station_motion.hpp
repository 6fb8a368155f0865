#pragma once

#include <Eigen/Core>

namespace vigia::localization {

/// The axes in which a displacement is given: the world's, or the robot's own at its beginning.
/// Wheels measure the latter; the world's axes take a heading.
enum class MotionFrame { world, body };

/// How a robot went from one place to another: displaced, then turned.
struct StationMotion {
  MotionFrame frame = MotionFrame::world;
  Eigen::Vector2d displacement_m = Eigen::Vector2d::Zero();
  double turn = 0.0;                                     ///< rad
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (dx, dy, turn), zero if exact
};

/// A heading that something else than the landmark tells: a compass, a prior.
struct HeadingPrior {
  double heading = 0.0;  ///< rad, in the world
  double sigma = 0.0;    ///< rad
};

/// A landmark's place by the map.
struct LandmarkPlace {
  Eigen::Vector2d p_w = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< zero if exact
};

}  // namespace vigia::localization
