#include "encoded_picture.hpp"

#include <algorithm>
#include <cctype>

namespace vigia::imaging {
namespace {

constexpr std::string_view kPngMagic("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kJpegMagic("\xff\xd8\xff", 3);

bool starts_with(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}

bool is_pnm(std::string_view bytes) {
  return starts_with(bytes, "P4") || starts_with(bytes, "P5") || starts_with(bytes, "P6");
}

std::size_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// The chain of chunks up to IEND.
std::optional<std::size_t> png_length(std::string_view bytes) {
  std::size_t at = kPngMagic.size();
  while (at + 12 <= bytes.size()) {
    const std::size_t length = big_endian(bytes, at, 4);
    const bool last = bytes.substr(at + 4, 4) == "IEND";
    if (length > bytes.size() - at - 12) return std::nullopt;
    at += 12 + length;
    if (last) return at;
  }
  return std::nullopt;
}

// The end of a JPEG scan's data: the next marker that is neither a stuffed byte nor a restart.
std::size_t scan_end(std::string_view bytes, std::size_t at) {
  for (; at + 1 < bytes.size(); ++at) {
    const auto next = static_cast<unsigned char>(bytes[at + 1]);
    const bool data = next == 0x00 || next == 0xff || (next >= 0xd0 && next <= 0xd7);
    if (static_cast<unsigned char>(bytes[at]) == 0xff && !data) break;
  }
  return at;
}

// The segments and the compressed scans up to the end-of-image marker.
std::optional<std::size_t> jpeg_length(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 2 <= bytes.size()) {
    if (static_cast<unsigned char>(bytes[at]) != 0xff) return std::nullopt;
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (marker == 0xff) {
      ++at;
      continue;
    }
    if (marker == 0xd9) return at + 2;
    if (at + 4 > bytes.size()) return std::nullopt;
    at += 2 + big_endian(bytes, at + 2, 2);
    if (marker == 0xda) at = scan_end(bytes, at);
  }
  return std::nullopt;
}

/// The next number of a PNM header, past blanks and comments; 0 at the end.
std::size_t pnm_number(std::string_view bytes, std::size_t& at) {
  while (at < bytes.size() && !std::isdigit(static_cast<unsigned char>(bytes[at]))) {
    if (bytes[at] == '#') at = std::min(bytes.find('\n', at), bytes.size() - 1);
    ++at;
  }
  std::size_t value = 0;
  for (; at < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[at])); ++at)
    value = std::min<std::size_t>(value * 10 + static_cast<std::size_t>(bytes[at] - '0'), 1 << 20);
  return value;
}

// The header of a binary PBM, PGM or PPM and all the rows that it promises.
std::optional<std::size_t> pnm_length(std::string_view bytes) {
  std::size_t at = 2;
  const std::size_t width = pnm_number(bytes, at);
  const std::size_t height = pnm_number(bytes, at);
  const bool bits = bytes[1] == '4';
  const std::size_t depth = bits || pnm_number(bytes, at) < 256 ? 1 : 2;
  const std::size_t channels = bytes[1] == '6' ? 3 : 1;
  const std::size_t row = bits ? (width + 7) / 8 : width * channels * depth;
  if (at >= bytes.size() || bytes.size() - at - 1 < row * height) return std::nullopt;
  return at + 1 + row * height;
}

}  // namespace

bool is_picture(std::string_view bytes) {
  return starts_with(bytes, kPngMagic) || starts_with(bytes, kJpegMagic) || is_pnm(bytes);
}

std::optional<std::size_t> picture_length(std::string_view bytes) {
  if (starts_with(bytes, kPngMagic)) return png_length(bytes);
  if (starts_with(bytes, kJpegMagic)) return jpeg_length(bytes);
  if (is_pnm(bytes)) return pnm_length(bytes);
  return std::nullopt;
}

}  // namespace vigia::imaging
