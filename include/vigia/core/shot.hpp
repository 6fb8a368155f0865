#pragma once

#include <cstdint>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/stamp.hpp"

namespace vigia {

/// Tells the cameras of a rig apart. Not negative.
using CameraId = int;

/// Numbers the acquisitions of a mission: a look is one acquisition of one landmark, from the gaze
/// order until it is released. 0 means no look.
using LookId = std::int64_t;

/// What the robot's own sensors said when an image was exposed. Everything here is a reading, not
/// the truth.
struct Shot {
  Stamp stamp;           ///< middle of the exposure
  CameraId camera = 0;   ///< which camera of the rig exposed it
  CameraModel model;     ///< calibrated, at the zoom's reading
  HeadAngles head;       ///< encoder readings
  double zoom_mm = 8.0;  ///< zoom motor's reading
  LookId look = 0;       ///< the acquisition that this image belongs to
};

/// The model of a shot where only a perspective camera makes sense: std::bad_variant_access when it
/// was another's.
inline const Intrinsics& pinhole(const Shot& shot) {
  return std::get<Intrinsics>(shot.model);
}

}  // namespace vigia
