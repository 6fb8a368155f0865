#pragma once

#include "vigia/core/actuation.hpp"
#include "vigia/core/camera.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/head.hpp"

namespace vigia::planner {

/// Head and zoom as the planner foresees them.
struct HeadModel {
  HeadGeometry geometry;
  HeadLimits limits;
  ZoomCalibration zoom;
  double radius_px = 24.0;  ///< apparent radius of a disc for which a zoom is set
  double dwell_s = 1.0;     ///< how long a landmark is tracked
  double fill = 0.8;        ///< half the image's height that a pattern or tag is to fill
  Ground ground = {};
};

}  // namespace vigia::planner
