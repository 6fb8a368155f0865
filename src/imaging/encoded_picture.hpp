#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace vigia::imaging {

/// Whether @p bytes begin as a PNG, a JPEG or a binary PBM, PGM or PPM does.
bool is_picture(std::string_view bytes);

/// How many bytes the picture takes with which @p bytes begin; nothing when it isn't one of those
/// formats, or ends early (OpenCV fills what a truncated file lacks and says nothing).
std::optional<std::size_t> picture_length(std::string_view bytes);

}  // namespace vigia::imaging
