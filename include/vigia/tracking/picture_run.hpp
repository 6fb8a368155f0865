#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/disc_tracker.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"

namespace vigia::tracking {

/// One target in one picture.
struct PictureRow {
  int target = 0;  ///< counts from 1 and keeps its number from picture to picture
  EllipseFeature feature;
};

struct PictureRunParams {
  std::string tracker = "disc";  ///< "disc", "ellipse" or "correlation"
  Polarity polarity = Polarity::either;
  double min_radius_px = 3.0;                                      ///< of the semi-minor axis
  double max_radius_px = std::numeric_limits<double>::infinity();  ///< of the semi-major axis
  double min_score = 0.0;  ///< targets of less are not found
  int every = 1;           ///< discs are looked for in every n-th picture, and tracked between
  int expected = 0;   ///< discs in sight; while so many are held none are looked for; 0: unknown
  int remember = 50;  ///< pictures for which a target that is not seen keeps its number
};

/// A tracker for pictures in which discs may be dark or bright; null for an unknown name.
std::unique_ptr<EllipseTracker> make_picture_tracker(const PictureRunParams& params);

/// Follows every disc through a sequence of pictures. In every n-th picture all discs are looked
/// for; each goes to the target that is predicted nearest to it by constant velocity, or becomes a
/// new one. A target that was not found so is tracked from where it is predicted. A target that is
/// lost keeps its number until it is forgotten. Where two targets come to the same disc, the one
/// that came from farther away has the wrong object. When the pictures change their size, all
/// targets are new; when most of several targets go at once and as many others come, it is another
/// scene, and what is lost is forgotten.
class PictureRun {
 public:
  /// Throws InputError when there is no such tracker.
  explicit PictureRun(const PictureRunParams& params);
  ~PictureRun();
  PictureRun(PictureRun&&) noexcept;

  /// The rows of all targets that are not forgotten, in the order of their numbers.
  std::vector<PictureRow> next(const imaging::Frame& picture);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// The columns of one ellipse and their names: status, u, v, a, b, psi_deg, their standard
/// deviations, score, contrast, visible and clipped shares, and the correlations of each two of (u,
/// v, a, b, psi). Numbers are empty for a target that was not found.
std::string ellipse_csv_header();
std::string ellipse_csv_fields(const EllipseFeature& feature);

/// Draws outlines, centres and numbers on a picture: found targets in yellow with a dark seam,
/// which stays legible on light and dark ground and for colour-blind eyes. Numbers stand where they
/// cover none of the others, if there is such a place.
void draw_overlay(const std::vector<PictureRow>& rows, vpImage<vpRGBa>& picture);

}  // namespace vigia::tracking
