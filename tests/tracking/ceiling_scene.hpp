#pragma once

#include <cmath>
#include <memory>

#include "vigia/core/angle.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/sim/ceiling_scene.hpp"

namespace vigia::tracking {

/// A hall with patches 2.2 m above a camera of 60° that looks up.
struct CeilingScene {
  explicit CeilingScene(const sim::CeilingTruth& ceiling, double contrast)
      : truth(ceiling), scene(hall(), look(contrast), ceiling, 3) {
    camera.px = camera.py = 0.5 * camera.width / std::tan(from_deg(30.0));
  }

  static WorldMap hall() {
    WorldMap world;
    world.plan = FloorPlan({{-50, -50}, {50, -50}, {50, 50}, {-50, 50}}, 2.7, {}, {});
    return world;
  }
  static sim::Appearance look(double contrast) {
    sim::Appearance look;
    look.contrast = contrast;
    return look;
  }
  std::unique_ptr<imaging::Frame> expose(const Pose2& pose, std::int64_t number) const {
    return scene.expose(to_isometry(pose, 0.5), camera, Stamp{number}, {});
  }
  Eigen::Vector2d image_of(const Pose2& robot, const Pose2& patch, double forward_m) const {
    const Pose2 p = compose(patch, {forward_m, 0.0, 0.0});
    return *project(camera, to_isometry(robot, 0.5).inverse() * Eigen::Vector3d(p.x, p.y, 2.7));
  }

  sim::CeilingTruth truth;
  sim::CeilingScene scene;
  Intrinsics camera;
};

}  // namespace vigia::tracking
