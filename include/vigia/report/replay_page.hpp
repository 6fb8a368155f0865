#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/belief.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/imaging/overlay.hpp"

namespace vigia::report {

/// A camera's picture, small, at one instant.
struct ReplayImage {
  double t_s = 0.0;
  std::string jpeg;          ///< the file's bytes
  imaging::Overlay overlay;  ///< in pixels of the camera's own picture
};

/// What one camera saw.
struct ReplayCamera {
  std::string name;
  int width = 0;  ///< of its own picture, px
  int height = 0;
  /// Directions in the base frame of the left and the right rim of what it sees, rad, at each of
  /// ReplayRun::t_s; empty for a camera that sees all round.
  std::vector<double> left;
  std::vector<double> right;
  std::vector<ReplayImage> images;  ///< in order of time
};

/// What one localizer believed at each of ReplayRun::t_s.
struct ReplayLocalizer {
  std::string name;
  bool primary = false;  ///< the robot is driven by it
  std::vector<Belief> beliefs;
  std::vector<double> bound_m;  ///< √ of the trace of the bound's position covariance
};

/// How well each landmark suited a look, as the planner judges it.
struct ReplaySuitability {
  std::vector<double> t_s;  ///< ascending
  /// In [0, 1] at each of t_s; NaN where the landmark could not be looked at.
  std::vector<std::pair<LandmarkId, std::vector<double>>> landmarks;
};

struct ReplayEvent {
  double t_s = 0.0;
  std::string kind;
  std::string text;
};

/// One drive as the page replays it. World frame, metres, radians, seconds.
struct ReplayRun {
  std::string name;
  std::uint64_t seed = 0;
  std::string version;
  std::string command;       ///< that repeats it
  std::string note;          ///< said below the page
  std::string summary_json;  ///< summary.json; its figures are the page's
  WorldMap world;
  Path planned;
  double robot_radius_m = 0.25;
  std::optional<Eigen::Vector2d> limits_m;  ///< √λ_max at which the robot looks, and stops

  std::vector<double> t_s;  ///< ascending; what follows has its length or is empty
  std::vector<Pose2> truth;
  std::vector<double> speed_mps;
  std::vector<double> pan;
  std::vector<double> tilt;
  std::vector<double> zoom_mm;
  std::vector<std::optional<LandmarkId>> target;  ///< of the present look
  ReplaySuitability suitability;                  ///< at times of its own; may be empty
  std::vector<ReplayLocalizer> localizers;
  std::vector<ReplayCamera> cameras;
  std::vector<ReplayEvent> events;
};

/// A self-contained page, one HTML file without any reference to another, that replays one drive
/// or several on one map, with cameras, timelines and events on one cursor. Ticks beyond
/// @p max_ticks a run are thinned out evenly. Names and texts are shown as text, whatever they
/// hold. Throws std::invalid_argument without a run, for a run without ticks, and for lengths that
/// differ.
std::string replay_page(const std::vector<ReplayRun>& runs, int max_ticks = 3000);

}  // namespace vigia::report
