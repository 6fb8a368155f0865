#pragma once

#include <filesystem>
#include <string>

#include "vigia/core/camera.hpp"

namespace vigia {

/// Reads a calibrated camera: ViSP's XML (one camera; the model with distortion, where it has one)
/// or OpenCV's YAML (`image_width`, `image_height`, `camera_matrix`, `distortion_coefficients` of
/// four to eight numbers k1 k2 p1 p2 k3 k4 k5 k6; ROS writes the same). OpenCV's distortion is
/// replaced by the one coefficient kdu that fits it best over the picture; a lens that this leaves
/// more than a pixel off is refused. Throws InputError with file:line:column.
Intrinsics read_camera(const std::filesystem::path& file);

/// The same from a text; @p name stands for the file in messages.
Intrinsics parse_camera(const std::string& text, const std::string& name);

}  // namespace vigia
