#pragma once

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

#include "vigia/tracking/tag_tracker.hpp"

namespace vigia::tracking {

/// A tag as libapriltag sees it, in pixels with integers at the pixels' centres.
struct TagDetection {
  int tag = 0;
  int hamming = 0;
  double decision_margin = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  /// Lower left, lower right, upper right, upper left, as the tag's reader sees them.
  std::array<Eigen::Vector2d, 4> corners;
};

/// libapriltag for the family 36h11, on one thread.
class TagDetector {
 public:
  TagDetector(double quad_decimate, int max_hamming);
  ~TagDetector();

  std::vector<TagDetection> detect(vpImage<unsigned char>& image);

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

}  // namespace vigia::tracking
