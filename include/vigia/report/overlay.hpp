#pragma once
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/imaging/overlay.hpp"

namespace vigia::report {

/// Draws the overlay on the image. Strokes and letters are outlined in black, so that they show on
/// any background; letters grow with the image. What lies outside the image or is not finite is
/// left out.
void draw_overlay(vpImage<vpRGBa>& image, const imaging::Overlay& overlay);

}  // namespace vigia::report
