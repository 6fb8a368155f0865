#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/pose.hpp"
#include "vigia/report/map_picture.hpp"

namespace vigia::report {

/// Distance that the robot has travelled at each instant of the true path, metres; the first is 0.
std::vector<double> travelled_m(const MapDrive& drive);

/// A line cut where it jumps.
struct CutLine {
  std::vector<std::vector<Eigen::Vector2d>> pieces;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> jumps;
};

/// @p points cut before each index of @p jumps.
CutLine cut_at(const std::vector<Eigen::Vector2d>& points, const std::vector<std::size_t>& jumps);
/// @p points cut where one is farther from the one before than a robot drives between two instants:
/// an estimate that was set anew.
CutLine cut_where_far(const std::vector<Eigen::Vector2d>& points);

/// √λ_max of the position part of a covariance of (x, y, θ), metres.
double position_sigma_m(const Eigen::Matrix3d& covariance);

/// The instant of each look on the true path: the nearest one, no earlier than that of the look
/// before.
std::vector<std::size_t> look_instants(const std::vector<Pose2>& truth,
                                       const std::vector<MapLook>& looks);

}  // namespace vigia::report
