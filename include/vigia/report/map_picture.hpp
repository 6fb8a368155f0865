#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/world_map.hpp"

namespace vigia::report {

/// An estimated pose with the covariance of (x, y, θ).
struct MapPose {
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// One look: the landmark that the localizer took it for, or else that was looked for, from where,
/// and whether the localizer used it.
struct MapLook {
  LandmarkId landmark = 0;
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< the true position in the middle of the look
  bool fused = true;
};

/// An instant that is marked on the map and in the chart.
struct MapMark {
  std::size_t instant = 0;  ///< index into MapDrive::truth
  std::string text;
  bool grave = false;  ///< something went wrong
};

/// What the picture of one drive shows. truth, estimate and odometry are sampled at the same
/// instants: they have the same length, or are empty where there is nothing to show. World frame,
/// metres.
struct MapDrive {
  const WorldMap& world;
  std::string title = {};
  std::string subtitle = {};
  Path planned = {};
  std::vector<Pose2> truth = {};
  std::vector<MapPose> estimate = {};
  std::string estimate_name = "estimate";
  std::vector<Pose2> odometry = {};
  /// Ascending indices into truth at which the robot had been put elsewhere since the instant
  /// before: a dashed line, which is no distance travelled.
  std::vector<std::size_t> jumps = {};
  std::vector<MapMark> marks = {};  ///< in order of time
  std::vector<MapLook> looks = {};  ///< in order of time
  /// Radius of a dashed ring round the place of each look that was used; 0: no rings.
  double look_ring_m = 0.0;
  double robot_radius_m = 0.25;
  /// How many times its size the estimate's 95 % ellipse is drawn; the legend says so. 0 chooses
  /// the largest of 1, 2, 5, 10, 20, 50 that keeps the ellipses small against the room.
  double ellipse_scale = 0.0;
  std::string footer = {};
};

/// Draws the drive to scale on its floor plan, and below it the position errors over the distance
/// travelled: the estimate's with twice its own √λ_max of the position covariance, and odometry's.
/// The ending of @p file (.png, .svg, .pdf) chooses the format. The same drive gives the same
/// bytes. The file is written aside and renamed. Throws InputError when it can't be written or has
/// another ending, std::invalid_argument when the lengths differ or a jump or mark has no instant.
void draw_map(const MapDrive& drive, const std::filesystem::path& file);

}  // namespace vigia::report
