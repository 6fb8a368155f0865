#pragma once

#include <vector>

#include "vigia/core/landmark.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/planner/visibility.hpp"

namespace vigia::planner {

struct PathModelParams {
  double turn_deg = 30.0;       ///< a change of heading above this …
  double turn_window_m = 0.3;   ///< … within this length is a turn point
  double turn_margin_m = 0.25;  ///< a control position nearer to a turn point is left out
  double spacing_m = 1.0;       ///< between control positions
  double radius_m = 0.5;        ///< of a control position's disc
  double area_m = 3.0;          ///< length of a control area, about
  double distance_ratio = 2.5;  ///< farthest over nearest distance to a landmark within one area
};

/// A disc on the path at which visibility is studied (Armingol §2.1).
struct ControlPosition {
  double station_m = 0.0;
  Pose2 pose;  ///< at the disc's centre, along the path
};

/// A stretch of the path over which the distances to the landmarks change little: one zoom setting.
struct ControlArea {
  double from_m = 0.0;
  double to_m = 0.0;
  std::vector<ControlPosition> positions;  ///< without those at turn points
};

/// The path as the perception planner sees it (Armingol, Fig. 2).
struct PathModel {
  std::vector<double> turn_points;  ///< stations, m
  std::vector<ControlArea> areas;   ///< in order; together they cover the path

  /// Index of the area that holds a station; the nearest for one beyond the path.
  std::size_t area_at(double station_m) const;
};

/// Models a path: turn points, control positions every spacing_m whose disc lies on the path, and
/// control areas. An area ends where its length would exceed area_m, or where the distance to a
/// landmark seen from it would change by more than distance_ratio. A path too short for a control
/// position has one in its middle.
PathModel model_path(const Path& path, const LandmarkMap& landmarks, const Visibility& visibility,
                     const PathModelParams& params);

/// The robot's pose when it follows the path, at a station.
Pose2 pose_on_path(const Path& path, double station_m);

}  // namespace vigia::planner
