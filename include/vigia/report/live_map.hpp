#pragma once

#include <memory>
#include <optional>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/core/belief.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/world_map.hpp"

namespace vigia::report {

/// A map of a drive that is going on: building or field, landmarks, planned route, and as the robot
/// moves its true track and that of the belief by which it is driven, with the 95 % ellipse.
class LiveMap {
 public:
  /// Of a building fitted into @p width × @p height pixels. @p world outlives the map.
  LiveMap(const WorldMap& world, const Path& route, double robot_radius_m, int width, int height);
  ~LiveMap();
  LiveMap(const LiveMap&) = delete;
  LiveMap& operator=(const LiveMap&) = delete;

  /// Adds a tick to the tracks.
  void move(const Pose2& truth, const Pose2& believed);
  /// The map as it is now, with the robot where the tracks end. @p target: the landmark that is
  /// looked for.
  vpImage<vpRGBa> picture(const Belief& belief, std::optional<LandmarkId> target) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vigia::report
