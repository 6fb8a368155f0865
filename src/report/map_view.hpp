#pragma once

#include "sheet.hpp"

#include <vector>

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"
#include "vigia/core/world_map.hpp"

namespace vigia::report {

/// Where the floor lies on the sheet: a part of the world, x to the right and y up, to scale.
struct MapView {
  Eigen::Vector2d min_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d max_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< the sheet's point of (min x, max y)
  double scale = 100.0;                              ///< sheet units per metre

  Box box() const;
  Eigen::Vector2d operator()(const Eigen::Vector2d& p_m) const;
  std::vector<Eigen::Vector2d> operator()(const std::vector<Eigen::Vector2d>& points_m) const;
};

/// Shows the outline of @p plan and @p margin_m round it, fitted into the width of @p space and at
/// most its height, centred.
MapView fit_view(const FloorPlan& plan, double margin_m, const Box& space);

/// The colour of a landmark's disc and of the sight lines to it. Four colours take turns in the
/// order of the map.
Colour landmark_colour(const LandmarkMap& landmarks, LandmarkId id);

/// The floor, the grid of whole metres, obstacles, partitions and the room's outline.
void draw_floor(const Sheet& sheet, const MapView& view, const FloorPlan& plan);

/// Ticks and figures in metres below and left of the map, and a bar of one metre or more.
void draw_axes(const Sheet& sheet, const MapView& view);

/// The disc of a landmark on its wall with a tick along its normal.
void draw_landmark(const Sheet& sheet, const MapView& view, const WorldMap& world,
                   const Landmark& landmark, Colour colour);

}  // namespace vigia::report
