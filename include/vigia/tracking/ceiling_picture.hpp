#pragma once

#include <string>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/tracking/patch_finder.hpp"

namespace vigia::tracking {

/// The columns of a ceiling's patches and their names, and the lines of a picture, each after
/// @p start: place (px) and direction (degrees, from u towards v), standard deviations and
/// correlations, the log-odds of its forward end, whether the border cuts it. A picture without a
/// patch has one line that says so.
std::string ceiling_csv_header();
std::string ceiling_csv_lines(const PatchScan& scan, const std::string& start);

/// Draws a cross at each patch and a line in its direction, whose length says how sure its forward
/// end is.
void draw_overlay(const PatchScan& scan, vpImage<vpRGBa>& picture);

}  // namespace vigia::tracking
