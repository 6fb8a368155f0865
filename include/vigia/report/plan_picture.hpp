#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/path.hpp"
#include "vigia/core/world_map.hpp"

namespace vigia::report {

/// A control area as the picture of a plan shows it.
struct PictureArea {
  double from_m = 0.0;  ///< stations on the path
  double to_m = 0.0;
  std::vector<Eigen::Vector2d> positions;  ///< control positions
  std::optional<LandmarkId> chosen;
  std::string label;  ///< beside the path, short: "0: L6 76 %"
};

/// What the picture of a perception plan shows. World frame, metres.
struct PlanPicture {
  const WorldMap& world;
  std::string title = {};
  std::string subtitle = {};
  Path path = {};
  std::vector<double> turn_points = {};  ///< stations
  double position_radius_m = 0.5;        ///< of a control position's disc
  std::vector<PictureArea> areas = {};
};

/// Draws the plan to scale on its floor plan: path, turn points, control areas and positions, and
/// from each position the line of sight to its area's landmark. The ending of @p file (.png, .svg,
/// .pdf) chooses the format; the same plan gives the same bytes. Throws InputError when the file
/// can't be written or has another ending.
void draw_plan(const PlanPicture& plan, const std::filesystem::path& file);

}  // namespace vigia::report
