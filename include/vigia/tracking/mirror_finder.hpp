#pragma once

#include <optional>

#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/field_palette.hpp"
#include "vigia/tracking/radial_scan.hpp"

namespace vigia::tracking {

/// The mirror that a picture shows, by its outline: the circle on which most of the strongest steps
/// of brightness lie, and within which green is; its inner radius is 0. Nothing where there is no
/// such circle.
std::optional<MirrorImage> find_mirror(const imaging::Frame& frame, const FieldPalette& palette);

/// The radius within which a mirror shows the robot rather than the field, px: inwards of the
/// greenest circle, where much less of what a circle meets is green.
double robot_radius(const imaging::Frame& frame, const MirrorImage& mirror,
                    const FieldPalette& palette);

}  // namespace vigia::tracking
