#pragma once

#include <string>

namespace vigia::imaging {

/// An MP4 file with its index before the pictures, so that a browser plays it while it loads it.
/// Bytes that are none, or have the index there already, as they are.
std::string with_index_first(const std::string& mp4);

}  // namespace vigia::imaging
