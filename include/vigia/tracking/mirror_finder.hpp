#pragma once

#include <optional>

#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/field_palette.hpp"
#include "vigia/tracking/radial_scan.hpp"

namespace vigia::tracking {

/// The mirror that a picture shows, by its outline: the circle on which most of the strongest steps
/// of brightness lie, and within which green is. Its inner radius is where green ceases to be most
/// of what a circle meets: there the robot sees itself. Nothing where there is no such circle.
std::optional<MirrorImage> find_mirror(const imaging::Frame& frame, const FieldPalette& palette);

}  // namespace vigia::tracking
