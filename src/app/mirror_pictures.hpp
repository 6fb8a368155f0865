#pragma once

#include <optional>
#include <string>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/core/field_map.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/localization/mirror_calibration.hpp"
#include "vigia/tracking/field_palette.hpp"
#include "vigia/tracking/radial_scan.hpp"

namespace vigia::app {

/// A picture of a mirror camera, where it shows the mirror, and the colours of its field.
struct MirrorView {
  std::string name;
  imaging::ImageFrame frame;
  tracking::MirrorImage mirror;
  tracking::FieldPalette palette;
};

/// Reads the pictures, all of one size. @p mirror: where they show it; without it, it is looked for
/// in each. Throws InputError.
std::vector<MirrorView> read_mirror_views(const std::vector<std::string>& inputs,
                                          const std::optional<tracking::MirrorImage>& mirror);

/// The points on lines that a picture shows along its rays. @p floor: the mirror as it is
/// calibrated, which tells how wide a line of @p width_m must be.
std::vector<localization::MirrorPoint> line_points(const MirrorView& view, double ray_step,
                                                   const localization::MirrorMount* floor,
                                                   double width_m);

/// Draws a field's painted edges as the mirror shows them from @p pose, and crosses at the points
/// that count as those of a line.
vpImage<vpRGBa> mirror_overlay(const MirrorView& view, const FieldMap& field,
                               const localization::MirrorMount& mount, const Pose2& pose,
                               const std::vector<localization::MirrorPoint>& points,
                               const std::vector<bool>& on);

}  // namespace vigia::app
