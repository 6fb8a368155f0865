#pragma once

#include <vector>

#include <Eigen/Core>

#include "vigia/core/field_map.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/stamp.hpp"

namespace vigia {

/// A point of a painted line's centre line on the floor, in the robot's frame, metres.
struct FieldPoint {
  Eigen::Vector2d p_r = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};

/// The middle of a goal's mouth, or a corner post's foot, told by its colour.
struct ColourSighting {
  FieldColour colour = FieldColour::yellow;  ///< of the goal; of the post's outer bands
  double bearing = 0.0;                      ///< rad from the robot's x axis
  double range_m = 1.0;
  double bearing_sigma = 0.01;
  double range_sigma_m = 0.1;
};

/// What one image of the mirror camera shows of the field, on the floor in the robot's frame.
struct FieldScan {
  Stamp stamp;
  std::vector<FieldPoint> points;
  std::vector<ColourSighting> goals;
  std::vector<ColourSighting> posts;
};

/// A point from bearing and range with independent errors.
FieldPoint polar_point(double bearing, double range_m, double bearing_sigma, double range_sigma_m);

/// What a robot at frame a would have seen at @p stamp of the scan of one at frame b: line points
/// and the places of goals and posts move, their errors turn with them.
FieldScan carried(const FieldScan& scan_b, const Pose2& aMb, Stamp stamp);

}  // namespace vigia
