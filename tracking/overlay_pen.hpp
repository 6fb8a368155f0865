#pragma once

#include <functional>
#include <string>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/core/vpImage.h>

#include "vigia/core/observation.hpp"

namespace vigia::tracking {

/// Draws on a picture at sub-pixel places.
class OverlayPen {
 public:
  OverlayPen(vpImage<vpRGBa>& picture, const cv::Scalar& colour, int width);

  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  /// An upright cross with arms of @p arm pixels.
  void cross(const Eigen::Vector2d& at, double arm) const;
  void ellipse(const Ellipse& ellipse) const;
  /// Writes with the left end of the base line at @p at.
  void text(const std::string& words, const cv::Point& at, double scale) const;

 private:
  cv::Mat canvas_;
  cv::Scalar colour_;
  int width_;
};

/// Calls @p draw twice, with a wide dark pen and a narrow light one, so that the lines stand out on
/// any ground.
void draw_twice(vpImage<vpRGBa>& picture, const std::function<void(const OverlayPen&)>& draw);

}  // namespace vigia::tracking
