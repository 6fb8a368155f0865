#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "vigia/tracking/point_tracker.hpp"

namespace vigia::tracking {

struct PatternTrackerParams {
  double min_contrast = 20.0;  ///< between dots and paper, grey levels of the luma
  /// Smallest share of a dot's outline that must agree with a blurred ellipse.
  double min_agreement = 0.9;
  /// Largest distance of a dot from where the others put it, in radii of the dot.
  double max_offset_ratio = 0.25;
  /// The code is in doubt below this probability that all its colours are right.
  double min_confidence = 0.999;
  /// Dots that a tracked pattern must show.
  int min_dots = 6;
  double search_margin_px = 16.0;
  double gate_sigmas = 3.5;
};

/// Finds, reads and tracks colour patterns (Adán et al., §3–4) in colour frames. Dots are blobs
/// darker than the paper; sixteen of them stand in two rings round a larger one as a homography of
/// the pattern's plane has it. Each dot's ellipse is fitted to that mixture of the colour channels
/// in which it stands out best from the paper, which reaches the Cramér–Rao bound of its centre.
/// A dot's colour is its level relative to the paper round it, less that of the black first point,
/// so that coloured light and glare cancel. Both rings carry the code: each colour is read from
/// the dots of its place that are seen whole, which must agree; a place without one, or a colour
/// near the border between two, makes the pattern unreadable. uv of a point is the centre of the
/// dot's ellipse, which is not the image of the dot's centre.
class PatternTracker : public PointTracker {
 public:
  explicit PatternTracker(const KnownCodes& known = {},
                          const PatternTrackerParams& parameters = {});
  ~PatternTracker() override;

  std::string_view name() const override { return "pattern"; }
  PointsFeature acquire(const imaging::Frame& frame, const PointsPrediction& prediction) override;
  PointsFeature track(const imaging::Frame& frame) override;
  std::vector<PointsFeature> find_all(const imaging::Frame& frame) override;
  void start(const imaging::Frame& frame, const PointsFeature& feature) override;
  void expect_motion(const Eigen::Vector2d& shift) override;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace vigia::tracking
