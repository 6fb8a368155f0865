#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vigia/tracking/radial_scan.hpp"

namespace vigia::app {

/// The numbers of a list A,B,C; nothing unless they are @p count finite ones and nothing else.
std::optional<std::vector<double>> parse_numbers(const std::string& text, std::size_t count);

/// What `--mirror` says: U,V,INNER,OUTER in pixels; nothing where it is not given. Throws
/// InputError.
std::optional<tracking::MirrorImage> parse_mirror(const std::string& text);

}  // namespace vigia::app
