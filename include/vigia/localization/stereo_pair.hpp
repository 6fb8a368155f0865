#pragma once

#include <optional>

#include <Eigen/Core>

#include "vigia/core/rig.hpp"

namespace vigia::localization {

/// A level pair of cameras at the height of what they measure: along the robot's x axis they look,
/// half a baseline to the left and to the right of it. Only columns count.
struct StereoPair {
  double focal_px = 277.1;
  double u0 = 159.5;  ///< column of the axes
  double baseline_m = 0.03;
  double forward_m = 0.0;  ///< x of both cameras in the robot's frame
};

/// The pair that a rig has, by its calibration.
StereoPair stereo_pair(const StereoCameras& cameras);

/// What the calibration of a pair misses: the true baseline is (1 + baseline) times the calibrated
/// one, the true focal length (1 + focal) times, and the cameras are each turned inwards by half of
/// vergence (rad). Also their standard deviations.
struct StereoErrors {
  double baseline = 0.0;
  double vergence = 0.0;
  double focal = 0.0;

  Eigen::Vector3d vector() const { return {baseline, vergence, focal}; }
};

/// Columns of one point in both images, px.
struct StereoColumns {
  double left = 0.0;
  double right = 0.0;

  Eigen::Vector2d vector() const { return {left, right}; }
};

/// Columns of a point and how they move with it and with the errors of calibration.
struct StereoImage {
  Eigen::Vector2d columns = Eigen::Vector2d::Zero();
  Eigen::Matrix2d dcolumns_dp = Eigen::Matrix2d::Zero();  ///< px/m
  Eigen::Matrix<double, 2, 3> dcolumns_derrors =
      Eigen::Matrix<double, 2, 3>::Zero();  ///< by baseline, vergence, focal
};

/// Image of a point of the floor in the robot's frame; nothing unless it lies in front of both
/// cameras.
std::optional<StereoImage> stereo_image(const StereoPair& pair, const StereoErrors& errors,
                                        const Eigen::Vector2d& p_r);

/// A point in the robot's frame with the covariance that the columns' errors give it.
struct StereoPoint {
  Eigen::Vector2d p_r = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// x = f b / disparity, y by the mean column; nothing where the disparity is not positive.
/// @p sigma_px is that of each column.
std::optional<StereoPoint> triangulate(const StereoPair& pair, const StereoColumns& columns,
                                       double sigma_px);

/// Range and bearing with covariance of both.
struct PolarSighting {
  double range_m = 0.0;
  double bearing = 0.0;  ///< from the robot's x axis towards y, rad
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};
PolarSighting polar(const StereoPoint& point);

}  // namespace vigia::localization
