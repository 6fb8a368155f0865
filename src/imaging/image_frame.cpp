#include "vigia/imaging/image_frame.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <visp3/core/vpImageConvert.h>

#include "vigia/core/error.hpp"

namespace vigia::imaging {
namespace {

template <typename Pixel>
void copy_window(const vpImage<Pixel>& image, const Window& window, Pixel* out,
                 std::ptrdiff_t stride) {
  for (int row = 0; row < window.height; ++row)
    std::copy_n(image[static_cast<unsigned>(window.v + row)] + window.u, window.width,
                out + row * stride);
}

}  // namespace

ImageFrame::ImageFrame(vpImage<unsigned char> grey) : grey_(std::move(grey)) {
  vpImageConvert::convert(grey_, colour_);
}

ImageFrame::ImageFrame(vpImage<vpRGBa> colour) : colour_(std::move(colour)) {
  vpImageConvert::convert(colour_, grey_);
}

int ImageFrame::width() const { return static_cast<int>(grey_.getWidth()); }
int ImageFrame::height() const { return static_cast<int>(grey_.getHeight()); }

void ImageFrame::read_grey(const Window& window, unsigned char* out, std::ptrdiff_t stride) const {
  copy_window(grey_, window, out, stride);
}

void ImageFrame::read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const {
  copy_window(colour_, window, out, stride);
}

}  // namespace vigia::imaging
