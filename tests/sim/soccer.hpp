#pragma once

#include <string>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/config.hpp"
#include "vigia/core/world_map.hpp"

namespace vigia::sim {

/// A world of config/worlds/ with a field.
inline WorldMap field_world(const std::string& name) {
  MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/worlds/" + name + ".yaml"), "world");
  return read_world_map(reader);
}

/// A parabolic mirror that shows the floor about the robot and a little above the horizon.
inline UnifiedOmni soccer_mirror() {
  UnifiedOmni mirror;
  mirror.px = 204.0;
  mirror.py = -204.0;
  mirror.max_angle = from_deg(99.0);
  return mirror;
}

}  // namespace vigia::sim
