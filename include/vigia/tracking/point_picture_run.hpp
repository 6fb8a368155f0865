#pragma once

#include <memory>
#include <string>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::tracking {

/// One pattern or tag in one picture.
struct PointPictureRow {
  int target = 0;  ///< counts from 1 and keeps its number; 0: seen but not read
  PointsFeature feature;
};

struct PointPictureRunParams {
  std::string tracker = "tag";           ///< "pattern" or "tag"
  std::vector<LandmarkCode> known = {};  ///< codes that count; none: all
  double min_confidence = 0.0;           ///< landmarks of less are not found
  int every = 1;     ///< landmarks are looked for in every n-th picture, and tracked between
  int expected = 0;  ///< landmarks in sight; while so many are held none are looked for; 0: unknown
  int remember = 50;  ///< pictures in which a target that is not seen is tried and reported
};

/// Follows every pattern or tag through a sequence of pictures, as PictureRun does with discs: a
/// target is known by its code, and of several that say the same the one counts that is predicted
/// nearest. A code that comes back has its number again, however long it was away. What is seen but
/// not read is reported and not followed.
class PointPictureRun {
 public:
  /// Throws InputError when there is no such tracker.
  explicit PointPictureRun(const PointPictureRunParams& params);
  ~PointPictureRun();
  PointPictureRun(PointPictureRun&&) noexcept;

  /// The rows of the targets that are followed, in the order of their numbers, then what is not
  /// read.
  std::vector<PointPictureRow> next(const imaging::Frame& picture);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// "floor-room-pattern" or the tag's number.
std::string to_string(const LandmarkCode& code);

/// The columns of one point and their names: status and code of the landmark, the point's label,
/// place, standard deviations and correlation. One line for each point, each after @p start; one
/// line without numbers for a landmark that was not found.
std::string points_csv_header();
std::string points_csv_lines(const PointsFeature& feature, const std::string& start);

/// Draws points, a tag's outline and codes on a picture, in yellow with a dark seam. The points'
/// labels are left out of a landmark that is too small for them.
void draw_overlay(const std::vector<PointPictureRow>& rows, vpImage<vpRGBa>& picture);

}  // namespace vigia::tracking
