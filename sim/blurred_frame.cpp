#include "blurred_frame.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vigia::sim {
namespace {

using imaging::Window;

std::size_t area(const Window& window) {
  return static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
}

void multiply(std::vector<float>& levels, float factor) {
  for (float& level : levels) level *= factor;
}

/// Weights of whole pixels whose variance is that of the blur: three where they can have it, else
/// a sampled Gaussian.
std::vector<float> lens_weights(double sigma_px) {
  if (!(sigma_px > 0.0)) return {};
  const double variance = sigma_px * sigma_px;
  if (variance <= 0.5) {
    const auto beside = static_cast<float>(0.5 * variance);
    return {1.0F - 2.0F * beside, beside};
  }
  std::vector<float> weights;
  float sum = 0.0F;
  for (int i = 0; i <= std::ceil(4.0 * sigma_px); ++i) {
    weights.push_back(static_cast<float>(std::exp(-0.5 * i * i / variance)));
    sum += (i == 0 ? 1.0F : 2.0F) * weights.back();
  }
  multiply(weights, 1.0F / sum);
  return weights;
}

/// @p light of @p wide, blurred along rows, then along columns, in @p window. What lies beyond the
/// frame's border is as the border is.
std::vector<float> through_lens(const std::vector<float>& light, const Window& wide,
                                const Window& window, const std::vector<float>& lens) {
  const int reach = static_cast<int>(lens.size()) - 1;
  const auto at = [](int row, int width, int column) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  };
  std::vector<float> rows(static_cast<std::size_t>(wide.height) *
                          static_cast<std::size_t>(window.width));
  for (int v = 0; v < wide.height; ++v) {
    for (int u = 0; u < window.width; ++u) {
      float sum = 0.0F;
      for (int k = -reach; k <= reach; ++k) {
        const int from = std::clamp(window.u - wide.u + u + k, 0, wide.width - 1);
        sum += lens[static_cast<std::size_t>(std::abs(k))] * light[at(v, wide.width, from)];
      }
      rows[at(v, window.width, u)] = sum;
    }
  }
  std::vector<float> out(area(window));
  for (int v = 0; v < window.height; ++v) {
    for (int u = 0; u < window.width; ++u) {
      float sum = 0.0F;
      for (int k = -reach; k <= reach; ++k) {
        const int from = std::clamp(window.v - wide.v + v + k, 0, wide.height - 1);
        sum += lens[static_cast<std::size_t>(std::abs(k))] * rows[at(from, window.width, u)];
      }
      out[at(v, window.width, u)] = sum;
    }
  }
  return out;
}

}  // namespace

BlurredFrame::BlurredFrame(std::vector<std::unique_ptr<Radiance>> instants, int width, int height,
                           const PixelNoise& noise, const ImagingParams& params, double lens_px)
    : instants_(std::move(instants)),
      width_(width),
      height_(height),
      noise_(noise),
      params_(params),
      lens_(lens_weights(lens_px)) {}

template <typename Add>
std::vector<float> BlurredFrame::light_of(const Window& window, const Add& add) const {
  const int reach = static_cast<int>(lens_.size()) - 1;
  if (reach < 1) {
    std::vector<float> sum(area(window), 0.0F);
    for (const auto& instant : instants_) add(*instant, window, sum);
    multiply(sum, 1.0F / static_cast<float>(instants_.size()));
    return sum;
  }
  const Window wide = intersect(
      {window.u - reach, window.v - reach, window.width + 2 * reach, window.height + 2 * reach},
      full());
  std::vector<float> sum(area(wide), 0.0F);
  for (const auto& instant : instants_) add(*instant, wide, sum);
  multiply(sum, 1.0F / static_cast<float>(instants_.size()));
  return through_lens(sum, wide, window, lens_);
}

void BlurredFrame::finish(const Window& window, int channel, const std::vector<float>& light,
                          unsigned char* out, std::ptrdiff_t stride) const {
  for (int row = 0; row < window.height; ++row)
    noise_.add_and_round(light.data() + static_cast<std::ptrdiff_t>(row) * window.width,
                         static_cast<float>(params_.noise_sigma), window.u, window.v + row, channel,
                         window.width, out + row * stride);
}

void BlurredFrame::read_grey(const Window& window, unsigned char* out,
                             std::ptrdiff_t stride) const {
  if (window.empty()) return;
  const auto add = [](const Radiance& instant, const Window& part, std::vector<float>& sum) {
    instant.add_grey(part, sum);
  };
  finish(window, 0, light_of(window, add), out, stride);
}

void BlurredFrame::read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const {
  if (window.empty()) return;
  std::vector<unsigned char> bytes(area(window));
  for (int channel = 0; channel < 3; ++channel) {
    const auto add = [channel](const Radiance& instant, const Window& part,
                               std::vector<float>& sum) {
      instant.add_channel(part, channel, sum);
    };
    finish(window, params_.colour ? channel : 0, light_of(window, add), bytes.data(), window.width);
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
