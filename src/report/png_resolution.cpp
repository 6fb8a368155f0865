#include "png_resolution.hpp"

#include "crc32.hpp"

#include <cmath>
#include <cstdint>

namespace vigia::report {
namespace {

constexpr std::size_t kHeaderEnd = 8 + 25;  // signature and IHDR

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (unsigned shift = 32; shift > 0;) bytes += static_cast<char>(value >> (shift -= 8) & 0xffU);
  return bytes;
}

}  // namespace

std::string with_resolution(const std::string& png, double dots_per_inch) {
  const auto per_metre = static_cast<std::uint32_t>(std::lround(dots_per_inch / kMetresPerInch));
  const std::string data = big_endian(per_metre) + big_endian(per_metre) + '\x01';
  const std::string chunk = "pHYs" + data;
  return png.substr(0, kHeaderEnd) + big_endian(static_cast<std::uint32_t>(data.size())) + chunk +
         big_endian(crc32(chunk)) + png.substr(kHeaderEnd);
}

}  // namespace vigia::report
