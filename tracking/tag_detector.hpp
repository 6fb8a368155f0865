#pragma once

#include "tag_fit.hpp"

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

namespace vigia::tracking {

/// A tag as libapriltag sees it, in pixels with integers at the pixels' centres.
struct TagDetection {
  int tag = 0;
  int hamming = 0;
  double decision_margin = 0.0;
  /// Lower left, lower right, upper right, upper left, as the tag's reader sees them.
  TagCorners corners;
};

/// What is asked of a detection of one family: short codes come about by chance.
struct TagDemands {
  int max_hamming = 0;
  double min_decision_margin = 0.0;
};

/// libapriltag for one family, on one thread.
class TagDetector {
 public:
  /// @p family is one of tag_families(). Throws InputError for another.
  TagDetector(const std::string& family, double quad_decimate, int max_hamming);
  ~TagDetector();

  std::vector<TagDetection> detect(vpImage<unsigned char>& image);

  /// How the family's tag number @p tag is printed.
  const TagGrid& grid(int tag);
  /// The least that a reading of this family must show.
  const TagDemands& demands() const;
  /// The probability that fields which are no tag at all do not read as one, with up to
  /// @p wrong_bits bits wrong.
  double confidence_of(int wrong_bits) const;

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

}  // namespace vigia::tracking
