#pragma once

#include <string>

#include "vigia/imaging/frame.hpp"

namespace vigia::imaging {

/// A small picture of a frame: of every k-th row the means of k neighbouring pixels, with the
/// smallest k for which it is at most @p max_width wide. Only those rows are computed.
vpImage<vpRGBa> thumbnail(const Frame& frame, int max_width);

/// The bytes of a JPEG file of that picture. @p quality in 1–100.
std::string encode_jpeg(const vpImage<vpRGBa>& image, int quality);

}  // namespace vigia::imaging
