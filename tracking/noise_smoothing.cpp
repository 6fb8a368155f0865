#include "noise_smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <opencv2/imgproc.hpp>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {

double noise_level(const vpImage<unsigned char>& image, const imaging::Window& window) {
  constexpr int kRows = 24;
  constexpr int kColumns = 96;
  const int row_step = std::max(1, window.height / kRows);
  const int column_step = std::max(1, window.width / kColumns);
  std::array<int, 512> histogram{};
  int count = 0;
  for (int v = window.v + row_step / 2; v < window.bottom(); v += row_step) {
    const unsigned char* row = image[static_cast<unsigned>(v)];
    for (int u = window.u + 1; u < window.right() - 1; u += column_step, ++count)
      ++histogram[static_cast<std::size_t>(std::abs(row[u - 1] - 2 * row[u] + row[u + 1]))];
  }
  if (count == 0) return 0.0;
  // The level within whose unit the median lies, divided as if its values were spread evenly.
  int below = 0;
  std::size_t level = 0;
  while (2 * (below + histogram[level]) < count) below += histogram[level++];
  const double median = static_cast<double>(level) - 0.5 +
                        (0.5 * count - below) / static_cast<double>(histogram[level]);
  // The median of a normal number's size is 0.6745 σ; 1, −2, 1 multiply σ by √6.
  return std::max(0.0, median) / (0.6745 * std::sqrt(6.0));
}

double smoothing_for(double noise, double min_contrast) {
  constexpr double kEdgeSigmas = 3.0;
  const double bearable = min_contrast / (kEdgeSigmas * std::sqrt(2.0));
  if (noise <= bearable) return 0.0;
  // A Gaussian of s px leaves 1/(2 √π s) of the noise.
  constexpr double kMargin = 1.4;  // what is left stays clear of the limit
  constexpr double kLeast = 1.0;
  constexpr double kMost = 4.0;
  return std::clamp(kMargin * noise / (2.0 * std::sqrt(kPi) * bearable), kLeast, kMost);
}

void smooth(const vpImage<unsigned char>& image, const imaging::Window& window, double sigma,
            vpImage<unsigned char>& out) {
  out.resize(image.getHeight(), image.getWidth());
  const auto part = [&](const vpImage<unsigned char>& whole) {
    return cv::Mat(static_cast<int>(whole.getHeight()), static_cast<int>(whole.getWidth()), CV_8U,
                   whole.bitmap)(cv::Rect(window.u, window.v, window.width, window.height));
  };
  // Isolated: the pixels beside the window may be of another picture.
  cv::GaussianBlur(part(image), part(out), cv::Size(), sigma, sigma,
                   cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
}

vpImage<unsigned char> halved(const vpImage<unsigned char>& image, const imaging::Window& window) {
  vpImage<unsigned char> out(static_cast<unsigned>(window.height / 2),
                             static_cast<unsigned>(window.width / 2));
  for (unsigned v = 0; v < out.getHeight(); ++v) {
    const unsigned char* upper = image[static_cast<unsigned>(window.v) + 2 * v] + window.u;
    const unsigned char* lower = image[static_cast<unsigned>(window.v) + 2 * v + 1] + window.u;
    for (unsigned u = 0; u < out.getWidth(); ++u)
      out[v][u] = static_cast<unsigned char>(
          (upper[2 * u] + upper[2 * u + 1] + lower[2 * u] + lower[2 * u + 1] + 2) / 4);
  }
  return out;
}

}  // namespace vigia::tracking
