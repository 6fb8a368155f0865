#include "vigia/imaging/image_frame.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <visp3/core/vpImageConvert.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"

namespace vigia::imaging {
namespace {

template <typename Pixel>
void copy_window(const vpImage<Pixel>& image, const Window& window, Pixel* out,
                 std::ptrdiff_t stride) {
  // vpRGBa copies pixel by pixel: assign the bytes, which are all that it has, a row at a time.
  const std::size_t bytes = sizeof(Pixel) * static_cast<std::size_t>(window.width);
  for (int row = 0; row < window.height; ++row) {
    const Pixel* from = image[static_cast<unsigned>(window.v + row)] + window.u;
    std::copy_n(reinterpret_cast<const unsigned char*>(from), bytes,
                reinterpret_cast<unsigned char*>(out + row * stride));
  }
}

constexpr std::string_view kPngMagic("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kJpegMagic("\xff\xd8\xff", 3);

bool starts_with(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}

std::size_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Whether the chain of chunks reaches IEND.
bool png_is_whole(std::string_view bytes) {
  std::size_t at = kPngMagic.size();
  while (at + 12 <= bytes.size()) {
    const std::size_t length = big_endian(bytes, at, 4);
    const bool last = bytes.substr(at + 4, 4) == "IEND";
    if (length > bytes.size() - at - 12) return false;
    if (last) return true;
    at += 12 + length;
  }
  return false;
}

/// Whether the segments and the compressed scans reach the end-of-image marker.
bool jpeg_is_whole(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    if (static_cast<unsigned char>(bytes[at]) != 0xff) return false;
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (marker == 0xff) {
      ++at;
      continue;
    }
    if (marker == 0xd9) return true;
    at += 2 + big_endian(bytes, at + 2, 2);
    if (marker != 0xda) continue;
    // A scan's data runs to the next marker that is neither a stuffed byte nor a restart.
    for (; at + 1 < bytes.size(); ++at) {
      const auto next = static_cast<unsigned char>(bytes[at + 1]);
      const bool data = next == 0x00 || next == 0xff || (next >= 0xd0 && next <= 0xd7);
      if (static_cast<unsigned char>(bytes[at]) == 0xff && !data) break;
    }
  }
  return at + 2 <= bytes.size() && big_endian(bytes, at, 2) == 0xffd9;
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

/// Whether a binary PBM, PGM or PPM holds all the rows that its header promises.
bool pnm_is_whole(std::string_view bytes) {
  std::size_t at = 2;
  const std::size_t width = pnm_number(bytes, at);
  const std::size_t height = pnm_number(bytes, at);
  const bool bits = bytes[1] == '4';
  const std::size_t depth = bits || pnm_number(bytes, at) < 256 ? 1 : 2;
  const std::size_t channels = bytes[1] == '6' ? 3 : 1;
  const std::size_t row = bits ? (width + 7) / 8 : width * channels * depth;
  return at < bytes.size() && bytes.size() - at - 1 >= row * height;
}

/// OpenCV fills what a truncated file lacks and says nothing: look for the end ourselves.
bool is_whole(std::string_view bytes) {
  if (starts_with(bytes, kPngMagic)) return png_is_whole(bytes);
  if (starts_with(bytes, kJpegMagic)) return jpeg_is_whole(bytes);
  if (starts_with(bytes, "P4") || starts_with(bytes, "P5") || starts_with(bytes, "P6"))
    return pnm_is_whole(bytes);
  return true;
}

std::string read_bytes(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file))
    throw InputError({file.string()}, "this is a directory where a picture is needed");
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError({file.string()},
                     std::string("cannot read this picture: ") + std::strerror(errno));
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) throw InputError({file.string()}, "reading this picture failed");
  return bytes;
}

}  // namespace

ImageFrame::ImageFrame(vpImage<unsigned char> grey) : grey_(std::move(grey)) {
  vpImageConvert::convert(grey_, colour_);
}

ImageFrame::ImageFrame(vpImage<vpRGBa> colour) : colour_(std::move(colour)) {
  vpImageConvert::convert(colour_, grey_);
}

int ImageFrame::width() const {
  return static_cast<int>(grey_.getWidth());
}
int ImageFrame::height() const {
  return static_cast<int>(grey_.getHeight());
}

void ImageFrame::read_grey(const Window& window, unsigned char* out, std::ptrdiff_t stride) const {
  copy_window(grey_, window, out, stride);
}

void ImageFrame::read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const {
  copy_window(colour_, window, out, stride);
}

ImageFrame read_image(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  if (bytes.empty()) throw InputError({file.string()}, "this file is empty; a picture is needed");
  if (!is_whole(bytes))
    throw InputError({file.string()}, "this picture ends early: truncated file");
  cv::Mat decoded;
  try {
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8UC1,
                      const_cast<char*>(bytes.data()));  // imdecode only reads it
    decoded = cv::imdecode(raw, cv::IMREAD_ANYCOLOR);
  } catch (const cv::Exception&) {
    decoded.release();
  }
  if (decoded.empty())
    throw InputError({file.string()}, "this is no picture that can be decoded (PNG, JPEG, PNM, …)");
  if (decoded.channels() == 1) {
    vpImage<unsigned char> grey;
    vpImageConvert::convert(decoded, grey);
    return ImageFrame(std::move(grey));
  }
  vpImage<vpRGBa> colour;
  vpImageConvert::convert(decoded, colour);
  return ImageFrame(std::move(colour));
}

void write_png(const std::filesystem::path& file, const vpImage<vpRGBa>& image) {
  cv::Mat bgr;
  vpImageConvert::convert(image, bgr);
  std::vector<unsigned char> bytes;
  if (bgr.empty() || !cv::imencode(".png", bgr, bytes))
    throw InputError({file.string()}, "this picture cannot be encoded as PNG");
  write_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace vigia::imaging
