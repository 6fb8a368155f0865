#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "vigia/tracking/disc_tracker.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"

namespace vigia::tracking {

struct CorrelationTrackerParameters {
  /// Scores in [0, 1] (Armingol §4.1): below acceptance there is no match; a position that reaches
  /// certainty ends the search.
  double acceptance = 0.6;
  double certainty = 0.9;
  double blur_px = 0.75;            ///< standard deviation of the template's edge, px
  double template_margin_px = 4.0;  ///< ground round the ellipse that belongs to the template
  double search_margin_px = 12.0;   ///< room round the prediction, px
  double max_scale_step = 0.3;      ///< largest change of log size between two frames
  double gate_sigmas = 3.5;         ///< of an acquisition, in the prediction's standard deviations
  /// Largest distance of the matched centre from that of the outline alone, px; more means that
  /// something covers a part.
  double max_outline_offset_px = 0.5;
  int max_iterations = 12;  ///< of the refinement
  /// How find_all finds its seeds, the polarity, and whether a slope of light and covered sectors
  /// of the outline are kept out of the match (robust).
  DiscTrackerParameters finder;
};

/// Tracks a disc by normalised grey-scale correlation (Armingol §4, eqs. 2 and 3, the indices of
/// eq. 2 put right): score = max(r, 0)², r the correlation of image and model. The model is
/// rendered anew for each search from the predicted ellipse, so that it follows zoom and
/// perspective. The search goes outward from the prediction and ends where the score reaches
/// certainty; then r is maximised over centre and shape by Gauss–Newton with the model rendered at
/// the sub-pixel estimate, so that nothing is interpolated. A whole frame without prediction is
/// searched with the disc detector's seeds.
class CorrelationTracker : public EllipseTracker {
 public:
  explicit CorrelationTracker(const CorrelationTrackerParameters& parameters = {});
  ~CorrelationTracker() override;

  std::string_view name() const override { return "correlation"; }
  EllipseFeature acquire(imaging::Canvas& canvas, const EllipsePrediction& prediction) override;
  EllipseFeature track(imaging::Canvas& canvas) override;
  std::vector<EllipseFeature> find_all(imaging::Canvas& canvas) override;
  void start(imaging::Canvas& canvas, const Ellipse& ellipse) override;
  void expect_motion(const Eigen::Vector2d& shift) override;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace vigia::tracking
