#pragma once

#include <visp3/core/vpImage.h>

#include "vigia/imaging/frame.hpp"

namespace vigia::tracking {

/// The standard deviation of the pixels' noise in grey levels, from a sample of the window: the
/// median second difference along the rows, which slopes of light do not touch and edges hardly.
/// Fine texture counts as noise. 0 for a window too small to tell.
double noise_level(const vpImage<unsigned char>& image, const imaging::Window& window);

/// The standard deviation in px of the smoothing after which noise makes no steps of
/// @p min_contrast between two pixels; 0 where there are none as it is.
double smoothing_for(double noise, double min_contrast);

/// The window of @p image smoothed by a Gaussian, into the same window of @p out. Reads nothing
/// outside it.
void smooth(const vpImage<unsigned char>& image, const imaging::Window& window, double sigma,
            vpImage<unsigned char>& out);

/// The window at half its size: each pixel the mean of two by two.
vpImage<unsigned char> halved(const vpImage<unsigned char>& image, const imaging::Window& window);

}  // namespace vigia::tracking
