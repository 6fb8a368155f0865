#include "vigia/imaging/thumbnail.hpp"

#include "media.hpp"

#include <stdexcept>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace vigia::imaging {
namespace {

unsigned char mean_of(const vpRGBa* pixels, int count, unsigned char vpRGBa::*channel) {
  int sum = 0;
  for (int i = 0; i < count; ++i) sum += pixels[i].*channel;
  return static_cast<unsigned char>((sum + count / 2) / count);
}

}  // namespace

vpImage<vpRGBa> thumbnail(const Frame& frame, int max_width) {
  if (max_width < 1) throw std::invalid_argument("a thumbnail has a width");
  const int step = (frame.width() + max_width - 1) / max_width;
  const int width = frame.width() / step;
  const int height = frame.height() / step;
  vpImage<vpRGBa> small(static_cast<unsigned>(height), static_cast<unsigned>(width));
  std::vector<vpRGBa> row(static_cast<std::size_t>(frame.width()));
  for (int v = 0; v < height; ++v) {
    frame.read_colour({0, v * step + step / 2, frame.width(), 1}, row.data(), frame.width());
    vpRGBa* const out = small[static_cast<unsigned>(v)];
    for (int u = 0; u < width; ++u) {
      const vpRGBa* const pixels = row.data() + u * step;
      out[u] = vpRGBa(mean_of(pixels, step, &vpRGBa::R), mean_of(pixels, step, &vpRGBa::G),
                      mean_of(pixels, step, &vpRGBa::B));
    }
  }
  return small;
}

std::string encode_jpeg(const vpImage<vpRGBa>& image, int quality) {
  const cv::Mat rgba(static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()),
                     CV_8UC4, image.bitmap);
  cv::Mat bgr;
  cv::cvtColor(rgba, bgr, cv::COLOR_RGBA2BGR);
  const std::vector<unsigned char> bytes =
      media().encode(".jpg", bgr, {cv::IMWRITE_JPEG_QUALITY, quality});
  return {bytes.begin(), bytes.end()};
}

}  // namespace vigia::imaging
