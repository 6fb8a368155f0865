#pragma once

#include <stdexcept>
#include <vector>

#include "vigia/core/config.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/planner/head_model.hpp"
#include "vigia/planner/route.hpp"
#include "vigia/planner/visibility.hpp"

namespace vigia::planner::test {

/// The mission config/missions/armingol-room.yaml as the planner meets it: room, route and the head
/// of config/robots/b21.yaml.
struct Armingol {
  Armingol() {
    MapReader mission(load_config(VIGIA_SOURCE_DIR "/config/missions/armingol-room.yaml"), "");
    MapReader world_reader = mission.map_or_file("world");
    world = read_world_map(world_reader);
    constexpr Range kCoordinate{0.0, 12.0};
    MapReader route_reader = mission.map("route");
    auto corners = route_reader.points2("via_m", kCoordinate, 1);
    corners.insert(corners.begin(), mission.map("start").vector2("position_m", kCoordinate));
    corners.push_back(route_reader.vector2("goal_m", kCoordinate));
    RouteParams params;
    params.robot_radius_m = 0.27;
    const Route route = plan_route(world.plan, corners, params, 1);
    if (route.status != RouteStatus::found) throw std::runtime_error("no route");
    path = route.path;
    head.geometry.mount_r = {0.15, 0.0, 1.2};
    head.limits.rate = from_deg(90.0);
    head.limits.acceleration = from_deg(450.0);
    head.zoom = ZoomCalibration(640, 480, 319.5, 239.5,
                                {{8.0, 581.8, 0.06}, {14.0, 1024.3, 0.03}, {48.0, 3490.9, 0.002}});
  }
  Visibility visibility() const { return {world.plan, head.geometry, head.limits, {}}; }

  WorldMap world;
  Path path;
  HeadModel head;
};

}  // namespace vigia::planner::test
