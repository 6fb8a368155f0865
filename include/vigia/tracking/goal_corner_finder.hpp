#pragma once

#include <optional>
#include <vector>

#include "vigia/core/field_map.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/field_palette.hpp"

namespace vigia::tracking {

struct GoalCornerParams {
  GoalCornerParams();

  FieldColours colours;    ///< of goals and walls
  int step_px = 4;         ///< between the pixels, and the rows, that are looked at for patches
  int min_patch = 2;       ///< such pixels in a patch
  int margin_px = 8;       ///< round a patch, where its corners are looked for
  int first_row = 0;       ///< rows above are not read
  int min_rows = 4;        ///< of an edge
  int side_px = 6;         ///< pixels of an edge's either side that are fitted, at most
  int max_mixed = 4;       ///< pixels between white and the colour, at most
  double max_step_px = 2;  ///< of an edge from row to row
  double blur_px = 0.8;    ///< σ of an edge, the pixel's own share in it, where the fit begins …
  double blur_sigma = 0.3;    ///< … and what is known of it, relative
  double slope_sigma = 0.05;  ///< px a row: what is known of an edge's lean
  double min_contrast = 60;   ///< between the two colours as vectors, grey levels
  double max_misfit = 0.12;   ///< rms of the fit's residuals by the contrast, at most …
  double max_noise = 12;      ///< … or this, grey levels, where that is more
  /// σ of what the model of an edge leaves out, px, added to the column's variance.
  double floor_px = 0.015;
};

/// The image of a goal's corner: the upright edge between a white wall and a coloured goal.
struct GoalCornerImage {
  FieldColour colour = FieldColour::yellow;
  bool colour_on_right = true;
  double u = 0.0;         ///< column of the edge in the middle of its rows, px
  double v = 0.0;         ///< that middle
  double sigma_px = 0.0;  ///< of u
  double slope = 0.0;     ///< px a row
  double blur_px = 0.0;   ///< σ of the edge
  double contrast = 0.0;  ///< grey levels
  double noise = 0.0;     ///< rms of the residuals, grey levels
  int first_row = 0;
  int rows = 0;  ///< that were fitted
};

/// What a frame shows of goals' corners.
struct GoalCornerScan {
  std::vector<GoalCornerImage> corners;
  std::vector<imaging::Window> windows;  ///< that were searched at full scale
  int rejected = 0;                      ///< groups of transitions that are no edge
};

/// Columns of the other image in which the same corner is looked for, relative to its own: both
/// bounds inclusive.
struct DisparityRange {
  double min_px = 0.0;
  double max_px = 100.0;
};

/// Finds corners of goals as Bais et al. do (§3.1): every fourth pixel of every fourth row tells
/// where the goals' colours are; about such patches every row is searched for transitions between
/// white and the colour; transitions of neighbouring rows make an edge, and those that lie off its
/// median are dropped. In place of one whole pixel of the group, the edge's column comes from a
/// fit of one leaning, blurred edge to all its rows, each with levels of its own, along the line
/// from one colour to the other, with the covariance that the residuals give it. Only sampled rows
/// and windows are read.
class GoalCornerFinder {
 public:
  explicit GoalCornerFinder(const GoalCornerParams& params = {});

  GoalCornerScan find(const imaging::Frame& frame) const;

  /// The same corner in the right image of a pair whose rows are level: where one edge of the same
  /// colours stands out in the columns that the range leaves. Nothing where there is none, or more
  /// than one.
  std::optional<GoalCornerImage> find_same(const imaging::Frame& right, const GoalCornerImage& left,
                                           const DisparityRange& range) const;

  const GoalCornerParams& params() const { return params_; }

 private:
  std::vector<imaging::Window> patches(const imaging::Frame& frame) const;

  GoalCornerParams params_;
  FieldPalette palette_;
};

}  // namespace vigia::tracking
