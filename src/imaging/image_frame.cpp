#include "vigia/imaging/image_frame.hpp"

#include "encoded_picture.hpp"
#include "media.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

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
  if (is_picture(bytes) && !picture_length(bytes))
    throw InputError({file.string()}, "this picture ends early: truncated file");
  return decode_picture(bytes, file.string());
}

ImageFrame decode_picture(std::string_view bytes, const std::string& name) {
  const cv::Mat decoded = media().decode(bytes);
  if (decoded.empty())
    throw InputError({name}, "this is no picture that can be decoded (PNG, JPEG, PNM, …)");
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
  const std::vector<unsigned char> bytes = media().encode(".png", bgr, {});
  if (bytes.empty()) throw InputError({file.string()}, "this picture cannot be encoded as PNG");
  write_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace vigia::imaging
