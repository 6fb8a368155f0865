#include "colour_block.hpp"

namespace vigia::tracking {
namespace {

// Rec. 709 in 256ths.
constexpr int kRed = 54;
constexpr int kGreen = 183;
constexpr int kBlue = 19;

int weighted(const vpRGBa& pixel) {
  return kRed * pixel.R + kGreen * pixel.G + kBlue * pixel.B;
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
  for (std::size_t i = 0; i < out.getSize(); ++i)
    out.bitmap[i] = static_cast<unsigned char>((weighted(pixels_[i]) + 128) >> 8);
}

void ColourBlock::halved_luma(vpImage<unsigned char>& out) const {
  const int width = window_.width / 2;
  const int height = window_.height / 2;
  out.resize(static_cast<unsigned>(height), static_cast<unsigned>(width));
  for (int y = 0; y < height; ++y) {
    const vpRGBa* above = row(window_.v + 2 * y);
    const vpRGBa* below = above + window_.width;
    unsigned char* line = out[static_cast<unsigned>(y)];
    for (int x = 0; x < width; ++x) {
      const int sum = weighted(above[2 * x]) + weighted(above[2 * x + 1]) + weighted(below[2 * x]) +
                      weighted(below[2 * x + 1]);
      line[x] = static_cast<unsigned char>((sum + 512) >> 10);
    }
  }
}

}  // namespace vigia::tracking
