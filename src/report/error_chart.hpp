#pragma once

#include "drive_layer.hpp"
#include "sheet.hpp"

#include "vigia/report/map_picture.hpp"

namespace vigia::report {

/// Position errors over the distance travelled in @p frame, with the looks below the axis.
void draw_error_chart(const Sheet& sheet, const Box& frame, const MapDrive& drive,
                      const DriveStyle& style);

}  // namespace vigia::report
