#pragma once

#include "vigia/tracking/radial_scan.hpp"

namespace vigia::tracking {

/// Whether the colours that @p scan met are those of the palette.
LightStatus light_status(const FieldPalette& palette, const RadialScan& scan);

}  // namespace vigia::tracking
