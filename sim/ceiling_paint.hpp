#pragma once

#include "stripe_view.hpp"

#include <vector>

#include <Eigen/Geometry>

#include "vigia/core/camera_model.hpp"
#include "vigia/sim/ceiling_truth.hpp"

namespace vigia::sim {

/// The patches and lamps that a camera at @p wMc may see on a ceiling at @p height_m whose index is
/// @p surface: those of the cells under its field of view, as far as ten metres from the camera.
/// Nothing is kept from one exposure to the next.
std::vector<StripeMark> ceiling_marks(const CeilingTruth& truth, double height_m,
                                      std::size_t surface, const Eigen::Isometry3d& wMc,
                                      const CameraModel& model);

}  // namespace vigia::sim
