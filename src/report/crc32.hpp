#pragma once

#include <cstdint>
#include <string_view>

namespace vigia::report {

/// CRC-32 as PNG and MCAP have it (ISO 3309). @p before: the CRC of what stands before @p bytes.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

}  // namespace vigia::report
