#pragma once

#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/field_palette.hpp"
#include "vigia/tracking/radial_scan.hpp"

namespace vigia::tracking {

/// The colours of the field that a picture shows within a mirror, without any mark: green is the
/// strongest hue among those that carpets have, white what is pale and brighter than it. A picture
/// with too little of either leaves those colours as they are in @p start.
FieldColours cluster_field_colours(const imaging::Frame& frame, const MirrorImage& mirror,
                                   const FieldColours& start = {});

}  // namespace vigia::tracking
