#pragma once

#include <memory>

#include "vigia/imaging/picture_source.hpp"

namespace vigia::imaging {

/// Encoded pictures that come one after the other through a file descriptor, which stays open.
std::unique_ptr<PictureSource> open_descriptor(int descriptor, const SourceParams& params);

}  // namespace vigia::imaging
