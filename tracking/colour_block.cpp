#include "colour_block.hpp"

#include "outline_loops.hpp"

#include <opencv2/imgproc.hpp>

namespace vigia::tracking {
namespace {

// Rec. 709 in 4096ths, and half for rounding.
constexpr ChannelMixture kLuma{864, 2928, 304, 2048};

cv::Mat matrix_of(vpImage<unsigned char>& image) {
  return {static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()), CV_8U,
          image.bitmap};
}

}  // namespace

void ColourBlock::read(const imaging::Frame& frame, const imaging::Window& window) {
  window_ = window;
  const auto count =
      static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
  // Never smaller again: a vector that grows writes to its new pixels first.
  if (pixels_.size() < count) pixels_.resize(count);
  frame.read_colour(window, pixels_.data(), window.width);
}

void ColourBlock::luma(vpImage<unsigned char>& out) const {
  out.resize(static_cast<unsigned>(window_.height), static_cast<unsigned>(window_.width));
  mix_channels(&pixels_.data()->R, kLuma, window_.width * window_.height, out.bitmap);
}

void halve(vpImage<unsigned char>& image, vpImage<unsigned char>& out) {
  const unsigned height = image.getHeight() / 2;
  const unsigned width = image.getWidth() / 2;
  out.resize(height, width);
  cv::Mat halved = matrix_of(out);
  cv::resize(matrix_of(image)(cv::Rect(0, 0, 2 * halved.cols, 2 * halved.rows)), halved,
             halved.size(), 0.0, 0.0, cv::INTER_AREA);
}

}  // namespace vigia::tracking
