#include "blurred_frame.hpp"

#include <utility>

namespace vigia::sim {
namespace {

std::size_t area(const imaging::Window& window) {
  return static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
}

}  // namespace

BlurredFrame::BlurredFrame(std::vector<std::unique_ptr<Radiance>> instants, int width, int height,
                           const PixelNoise& noise, const ImagingParams& params)
    : instants_(std::move(instants)),
      width_(width),
      height_(height),
      noise_(noise),
      params_(params) {}

void BlurredFrame::finish(const imaging::Window& window, int channel, std::vector<float>& sum,
                          unsigned char* out, std::ptrdiff_t stride) const {
  const float share = 1.0F / static_cast<float>(instants_.size());
  for (float& level : sum) level *= share;
  for (int row = 0; row < window.height; ++row)
    noise_.add_and_round(sum.data() + static_cast<std::ptrdiff_t>(row) * window.width,
                         static_cast<float>(params_.noise_sigma), window.u, window.v + row, channel,
                         window.width, out + row * stride);
}

void BlurredFrame::read_grey(const imaging::Window& window, unsigned char* out,
                             std::ptrdiff_t stride) const {
  if (window.empty()) return;
  std::vector<float> sum(area(window), 0.0F);
  for (const auto& instant : instants_) instant->add_grey(window, sum);
  finish(window, 0, sum, out, stride);
}

void BlurredFrame::read_colour(const imaging::Window& window, vpRGBa* out,
                               std::ptrdiff_t stride) const {
  if (window.empty()) return;
  std::vector<unsigned char> bytes(area(window));
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float> sum(area(window), 0.0F);
    for (const auto& instant : instants_) instant->add_channel(window, channel, sum);
    finish(window, params_.colour ? channel : 0, sum, bytes.data(), window.width);
    for (int row = 0; row < window.height; ++row) {
      for (int column = 0; column < window.width; ++column) {
        vpRGBa& pixel = out[row * stride + column];
        const unsigned char level =
            bytes[static_cast<std::size_t>(row) * static_cast<std::size_t>(window.width) +
                  static_cast<std::size_t>(column)];
        (channel == 0 ? pixel.R : channel == 1 ? pixel.G : pixel.B) = level;
        pixel.A = vpRGBa::alpha_default;
      }
    }
  }
}

}  // namespace vigia::sim
