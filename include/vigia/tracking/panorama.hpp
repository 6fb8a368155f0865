#pragma once

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/radial_scan.hpp"

namespace vigia::tracking {

/// A mirror's picture unwrapped (Minho Fig. 4): one column a direction, the image's u axis in the
/// middle and angles in the image growing to the right; one row a radius, the mirror's edge on top
/// and its inner radius below. As wide as the circle half-way is long.
vpImage<vpRGBa> unwrapped_panorama(const imaging::Frame& frame, const MirrorImage& mirror);

}  // namespace vigia::tracking
