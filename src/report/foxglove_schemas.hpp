#pragma once

#include <array>

#include "vigia/report/mcap_writer.hpp"

namespace vigia::report::foxglove {

/// In the order of Message. Made from foxglove/ by foxglove/embed.cmake.
extern const std::array<McapSchema, 9> kSchemas;

}  // namespace vigia::report::foxglove
