#pragma once

#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "vigia/core/observation.hpp"

namespace vigia::tracking {

/// The upright rectangle round an ellipse.
cv::Rect box_of(const Ellipse& ellipse);

/// Finds places for labels beside what they name, so that they bury as little as possible of what
/// else is drawn.
class LabelPlaces {
 public:
  LabelPlaces(int width, int height) : picture_(0, 0, width, height) {}

  /// Labels are to stay off @p box.
  void keep_free(const cv::Rect& box) { taken_.push_back(box); }
  /// The lower left corner of a text beside @p thing, which is kept free from then on.
  cv::Point place(const cv::Rect& thing, const std::string& words, double scale);

 private:
  cv::Rect picture_;
  std::vector<cv::Rect> taken_;
};

}  // namespace vigia::tracking
