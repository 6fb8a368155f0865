#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"

namespace vigia::tracking {

/// One target in one picture.
struct PictureRow {
  std::filesystem::path image;
  int target = 0;  ///< counts from 1 and keeps its number from picture to picture
  EllipseFeature feature;
};

/// The rows of one picture, and the picture.
struct PictureResult {
  std::filesystem::path image;
  std::vector<PictureRow> rows;
};

/// A tracker for pictures in which discs may be dark or bright: "disc", "ellipse" or "correlation".
/// Null for another name.
std::unique_ptr<EllipseTracker> make_picture_tracker(const std::string& name);

/// Follows every disc through a sequence of pictures. In the first picture each disc is found
/// without prediction; then each is tracked. A target that is lost keeps its number and is tried
/// again in the next picture, with what its last sight predicts. Where two targets come to the same
/// disc, the one that came from farther away has the wrong object and is given up. When the
/// pictures change their size, or more than half of the targets are lost or given up (another
/// scene), the discs are found anew and numbered on.
class PictureRun {
 public:
  /// Throws InputError when there is no such tracker.
  explicit PictureRun(const std::string& tracker);

  PictureResult next(const std::filesystem::path& name, const imaging::ImageFrame& picture);

 private:
  struct Target {
    int number;
    std::unique_ptr<EllipseTracker> tracker;
    Ellipse last;  ///< as it was last found
  };

  std::vector<PictureRow> find(const std::filesystem::path& name, imaging::Canvas& canvas);
  std::vector<PictureRow> follow(const std::filesystem::path& name, imaging::Canvas& canvas);
  void give_up_doubles(std::vector<PictureRow>& rows);

  std::string tracker_;
  std::unique_ptr<EllipseTracker> finder_;
  std::vector<Target> targets_;
  int numbers_ = 0;
  std::size_t found_anew_ = 0;  ///< how many discs the last search found
  int width_ = 0;
  int height_ = 0;
};

/// Reads each file and hands its result to @p report, with the picture. Throws InputError for a
/// file that can't be read or an unknown tracker.
void run_pictures(
    const std::string& tracker, const std::vector<std::filesystem::path>& files,
    const std::function<void(const PictureResult&, const imaging::ImageFrame&)>& report);

/// The header and one line of the table: image, target, status, u, v, a, b, psi_deg, their standard
/// deviations, score, contrast. Numbers are empty for a target that was not found.
std::string picture_csv_header();
std::string picture_csv_line(const PictureRow& row);

/// Draws outlines, centres and numbers on a picture: found targets in yellow with a dark seam,
/// which stays legible on light and dark ground and for colour-blind eyes.
void draw_overlay(const PictureResult& result, vpImage<vpRGBa>& picture);

}  // namespace vigia::tracking
