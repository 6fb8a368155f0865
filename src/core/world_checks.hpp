#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vigia/core/config.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/landmark.hpp"

namespace vigia {

inline constexpr Range kCoordinate{-1000.0, 1000.0};  // metres
inline constexpr double kShortestWall = 1e-3;         // metres
inline constexpr double kMountedWithin = 0.02;  // metres between a mounted landmark and its face

/// A landmark as the file gives it, with what its checks need.
struct PlacedLandmark {
  Landmark landmark;
  double normal_yaw = 0.0;
  bool free_standing = false;
  std::optional<MapReader> reader;  ///< of its map in the file
};

/// Each of these throws InputError, located by @p reader, unless the world makes sense.

/// A polygon is simple and has an area.
void check_polygon(const std::vector<Eigen::Vector2d>& polygon, const MapReader& reader,
                   const std::string& key);
void check_below_ceiling(double height_m, double ceiling_m, const MapReader& reader);
/// A segment lies in the room; it may touch the outline.
void check_segment_in_room(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                           const std::vector<Eigen::Vector2d>& outline, const MapReader& reader,
                           const std::string& key);
/// A landmark lies in the room, in no solid, and on the front of a face that holds all of it.
void check_mounting(const PlacedLandmark& placed, const FloorPlan& plan);
/// The last landmark has an id and a place of its own.
void check_against_earlier(const std::vector<PlacedLandmark>& placed);

}  // namespace vigia
