#pragma once

#include <string>

#include "vigia/core/config.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {

inline Landmark disc_on_wall(LandmarkId id, const Eigen::Vector3d& centre_w, double normal_deg,
                             double radius_m = 0.1) {
  Landmark landmark;
  landmark.id = id;
  landmark.wMl = wall_mount(centre_w, from_deg(normal_deg));
  landmark.shape = DiscShape{radius_m};
  return landmark;
}

/// 12×7 m with a partition at x = 7 from the upper wall, a box, and six discs.
inline WorldMap test_room() {
  WorldMap world;
  world.name = "test room";
  world.plan = FloorPlan({{0, 0}, {12, 0}, {12, 7}, {0, 7}}, 2.8, {Wall{{7, 7}, {7, 5}, 2.8}},
                         {Obstacle{{{5, 2.2}, {6.2, 2.2}, {6.2, 3.0}, {5, 3.0}}, 0.8}});
  world.landmarks =
      LandmarkMap({disc_on_wall(0, {12, 3, 1.7}, 180), disc_on_wall(1, {9, 7, 1.6}, -90),
                   disc_on_wall(2, {4, 7, 1.6}, -90), disc_on_wall(3, {0, 4, 1.7}, 0),
                   disc_on_wall(4, {7, 6, 1.5}, 180), disc_on_wall(6, {9, 0, 1.5}, 90)});
  return world;
}

inline std::shared_ptr<const Appearance> appearance_of(const WorldMap& world,
                                                       const std::string& keys) {
  MapReader reader(parse_config("version: 1\nappearance: {" + keys + "}\n", "test"), "world");
  return read_appearance(reader, world);
}

inline Intrinsics camera(double focal_px, double kdu = 0.0) {
  Intrinsics intrinsics;
  intrinsics.px = intrinsics.py = focal_px;
  intrinsics.kdu = kdu;
  return intrinsics;
}

inline Eigen::Isometry3d camera_at(double x, double y, double heading_deg, double tilt_deg = 0.0) {
  HeadGeometry geometry;
  geometry.mount_r = {0.0, 0.0, 1.2};
  return to_isometry(Pose2{x, y, from_deg(heading_deg)}) *
         camera_in_base(geometry, {0.0, from_deg(tilt_deg)});
}

}  // namespace vigia::sim
