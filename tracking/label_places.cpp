#include "label_places.hpp"

#include "ellipse_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vigia::tracking {

cv::Rect box_of(const Ellipse& ellipse) {
  const imaging::Window window = window_round(shape_of(ellipse), 0.0);
  return {window.u, window.v, window.width, window.height};
}

cv::Point LabelPlaces::place(const cv::Rect& thing, const std::string& words, double scale) {
  constexpr int kSeam = 3;  // width of the dark stroke under a text
  constexpr int kGap = 2;
  int below = 0;
  const cv::Size text =
      cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, scale, kSeam, &below) + cv::Size(2, 2);
  const int left = thing.x - text.width - kGap;
  const int right = thing.x + thing.width + kGap;
  const int above = thing.y - text.height - kGap;
  const int under = thing.y + thing.height + kGap;
  const int middle_u = thing.x + (thing.width - text.width) / 2;
  const int middle_v = thing.y + (thing.height - text.height) / 2;
  const std::array<cv::Point, 8> corners{cv::Point(right, above), {right, middle_v}, {right, under},
                                         {middle_u, above},       {middle_u, under}, {left, above},
                                         {left, middle_v},        {left, under}};
  cv::Rect best;
  double least = 0.0;
  for (const cv::Point& corner : corners) {
    const cv::Rect box(corner, text);
    double buried = 2.0 * (box.area() - (box & picture_).area());
    for (const cv::Rect& other : taken_) buried += (box & other).area();
    if (best.empty() || buried < least) {
      best = box;
      least = buried;
    }
  }
  taken_.push_back(best);
  return {std::clamp(best.x, 1, std::max(1, picture_.width - text.width - 1)),
          std::clamp(best.y + text.height - 1, text.height,
                     std::max(text.height, picture_.height - 3))};
}

}  // namespace vigia::tracking
