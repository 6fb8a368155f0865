#pragma once

#include <vector>

#include <Eigen/Core>

#include "vigia/core/camera_model.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/imaging/tag_bitmap.hpp"

namespace vigia::sim {

/// The share of each pixel of @p window (row by row) that a tag's black fields cover, seen through
/// the lens. @p dHray maps a ray to the tag's plane, in which the tag fills |x|, |y| ≤ 1
/// and y points up. A pixel is taken for the quadrilateral of its corners' images, on which the
/// share is exact.
std::vector<float> tag_coverage(const imaging::TagBitmap& black, const Eigen::Matrix3d& dHray,
                                const CameraModel& model, const imaging::Window& window);

}  // namespace vigia::sim
