#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::tracking {

/// One pattern or tag in one picture.
struct PointPictureRow {
  int target = 0;  ///< counts from 1 and keeps its number from picture to picture
  PointsFeature feature;
};

struct PointPictureResult {
  std::filesystem::path image;
  std::vector<PointPictureRow> rows;
};

/// Follows every pattern or tag through a sequence of pictures, as PictureRun does with discs. What
/// is seen but not read is reported and not followed.
class PointPictureRun {
 public:
  /// "pattern" or "tag". Throws InputError when there is no such tracker.
  explicit PointPictureRun(const std::string& tracker);

  PointPictureResult next(const std::filesystem::path& name, const imaging::ImageFrame& picture);

 private:
  struct Target {
    int number;
    std::unique_ptr<PointTracker> tracker;
  };

  std::vector<PointPictureRow> find(const imaging::ImageFrame& picture);

  std::string tracker_;
  std::unique_ptr<PointTracker> finder_;
  std::vector<Target> targets_;
  int numbers_ = 0;
  int width_ = 0;
  int height_ = 0;
};

/// "floor-room-pattern" or the tag's number.
std::string to_string(const LandmarkCode& code);

/// The header and the lines of one picture: a line a point, with its label, place, standard
/// deviations and correlation; one line without numbers for a landmark that was not found.
std::string point_csv_header();
std::string point_csv_lines(const PointPictureResult& result);

/// Draws points, a tag's outline and codes on a picture, in yellow with a dark seam.
void draw_overlay(const PointPictureResult& result, vpImage<vpRGBa>& picture);

}  // namespace vigia::tracking
