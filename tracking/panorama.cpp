#include "vigia/tracking/panorama.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vigia::tracking {

vpImage<vpRGBa> unwrapped_panorama(const imaging::Frame& frame, const MirrorImage& mirror) {
  vpImage<vpRGBa> image = imaging::colour_image(frame);
  const cv::Mat whole(frame.height(), frame.width(), CV_8UC4, image.bitmap);
  const int rows = std::max(1, static_cast<int>(std::lround(mirror.outer_px - mirror.inner_px)));
  const int columns =
      std::max(1, static_cast<int>(std::lround(kPi * (mirror.outer_px + mirror.inner_px))));
  cv::Mat1f u(rows, columns);
  cv::Mat1f v(rows, columns);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double angle = 2.0 * kPi * (column + 0.5) / columns - kPi;
      const double radius = mirror.outer_px - row - 0.5;
      u(row, column) = static_cast<float>(mirror.centre.x() + radius * std::cos(angle));
      v(row, column) = static_cast<float>(mirror.centre.y() + radius * std::sin(angle));
    }
  vpImage<vpRGBa> out(static_cast<unsigned>(rows), static_cast<unsigned>(columns));
  cv::Mat unwrapped(rows, columns, CV_8UC4, out.bitmap);
  cv::remap(whole, unwrapped, u, v, cv::INTER_LINEAR, cv::BORDER_CONSTANT,
            cv::Scalar(0, 0, 0, 255));
  return out;
}

}  // namespace vigia::tracking
