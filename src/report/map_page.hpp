#pragma once

#include "map_view.hpp"
#include "sheet.hpp"

#include <string>

namespace vigia::report {

/// The page of a picture of the floor: a title, the map, and below it what the picture adds.
inline constexpr double kPageWidth = 1600.0;
inline constexpr double kPageLeft = 84.0;
inline constexpr double kPageRight = 30.0;
inline constexpr double kPageText = kPageWidth - kPageLeft - kPageRight;  ///< width of the map

/// Where the map lies on the page.
MapView page_view(const FloorPlan& plan);

void draw_page_title(const Sheet& sheet, const std::string& title, const std::string& subtitle);

}  // namespace vigia::report
