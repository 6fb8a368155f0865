#include "overlay_pen.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

constexpr int kShift = 4;  // OpenCV's sub-pixel drawing, sixteenths

int sixteenths(double value) {
  return static_cast<int>(std::lround(16.0 * value));
}

cv::Point fine(const Eigen::Vector2d& uv) {
  return {sixteenths(uv.x()), sixteenths(uv.y())};
}

}  // namespace

OverlayPen::OverlayPen(vpImage<vpRGBa>& picture, const cv::Scalar& colour, int width)
    : canvas_(static_cast<int>(picture.getHeight()), static_cast<int>(picture.getWidth()), CV_8UC4,
              picture.bitmap),
      colour_(colour),
      width_(width) {}

void OverlayPen::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  cv::Mat canvas = canvas_;
  cv::line(canvas, fine(from), fine(to), colour_, width_, cv::LINE_AA, kShift);
}

void OverlayPen::cross(const Eigen::Vector2d& at, double arm) const {
  line(at - Eigen::Vector2d(arm, 0.0), at + Eigen::Vector2d(arm, 0.0));
  line(at - Eigen::Vector2d(0.0, arm), at + Eigen::Vector2d(0.0, arm));
}

void OverlayPen::ellipse(const Ellipse& ellipse) const {
  cv::Mat canvas = canvas_;
  cv::ellipse(canvas, fine({ellipse.u, ellipse.v}),
              cv::Size(sixteenths(ellipse.a), sixteenths(ellipse.b)), to_deg(ellipse.psi), 0.0,
              360.0, colour_, width_, cv::LINE_AA, kShift);
}

void OverlayPen::text(const std::string& words, const cv::Point& at, double scale) const {
  cv::Mat canvas = canvas_;
  cv::putText(canvas, words, at, cv::FONT_HERSHEY_SIMPLEX, scale, colour_, width_, cv::LINE_AA);
}

void draw_twice(vpImage<vpRGBa>& picture, const std::function<void(const OverlayPen&)>& draw) {
  // vpRGBa is R, G, B, A in memory.
  draw(OverlayPen(picture, cv::Scalar(20, 20, 60, 255), 3));
  draw(OverlayPen(picture, cv::Scalar(255, 210, 0, 255), 1));
}

}  // namespace vigia::tracking
