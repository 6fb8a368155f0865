#include "bgr_frame.hpp"

#include <algorithm>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace vigia::imaging {
namespace {

// 0.2126 R + 0.7152 G + 0.0722 B in 16384ths, as vpImageConvert has it.
void grey_of_bgr(const unsigned char* bgr, int count, unsigned char* out) {
  constexpr int kShift = 14;
  constexpr int kBlue = 1183;
  constexpr int kGreen = 11718;
  constexpr int kRed = 3483;
  constexpr int kHalf = 1 << (kShift - 1);
  for (int i = 0; i < count; ++i)
    out[i] = static_cast<unsigned char>(
        (kBlue * bgr[3 * i] + kGreen * bgr[3 * i + 1] + kRed * bgr[3 * i + 2] + kHalf) >> kShift);
}

}  // namespace

BgrFrame::BgrFrame(cv::Mat bgr) : bgr_(std::move(bgr)) {
  if (bgr_.channels() == 4) cv::cvtColor(bgr_, bgr_, cv::COLOR_BGRA2BGR);
}

void BgrFrame::read_grey(const Window& window, unsigned char* out, std::ptrdiff_t stride) const {
  for (int row = 0; row < window.height; ++row, out += stride) {
    const unsigned char* from = bgr_.ptr(window.v + row);
    if (bgr_.channels() == 1)
      std::copy_n(from + window.u, window.width, out);
    else
      grey_of_bgr(from + 3 * static_cast<std::ptrdiff_t>(window.u), window.width, out);
  }
}

void BgrFrame::read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const {
  for (int row = 0; row < window.height; ++row, out += stride) {
    const unsigned char* from = bgr_.ptr(window.v + row);
    for (int i = 0; i < window.width; ++i) {
      const std::ptrdiff_t u = window.u + i;
      out[i] = bgr_.channels() == 1 ? vpRGBa(from[u], from[u], from[u])
                                    : vpRGBa(from[3 * u + 2], from[3 * u + 1], from[3 * u]);
    }
  }
}

}  // namespace vigia::imaging
