#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "vigia/tracking/ellipse_tracker.hpp"

namespace vigia::tracking {

/// Which discs are landmarks.
enum class Polarity { dark, bright, either };

struct DiscTrackerParameters {
  Polarity polarity = Polarity::dark;
  double min_axis_px = 3.0;     ///< smallest semi-minor axis that is looked for
  double min_axis_ratio = 0.3;  ///< flattest ellipse b/a where nothing is known
  double min_contrast = 30.0;   ///< between disc and ground, grey levels
  double min_contrast_to_noise = 4.0;
  /// Bounds of a blob's area over π a b of its moments, and of its area over its rows' spans.
  double min_fill = 0.93;
  double max_fill = 1.06;
  double min_solidity = 0.95;
  /// Largest rms distance of a blob's outline, and of the fitted outline's sectors (less what the
  /// noise explains), from an ellipse: px, and further px per px of the semi-minor axis.
  double max_outline_px = 0.4;
  double max_outline_ratio = 0.01;
  double max_raggedness_px = 0.18;
  double max_raggedness_ratio = 0.005;
  /// Smallest share of the outline that must agree with a blurred ellipse.
  double min_agreement = 0.9;
  /// Below this share the outline is no disc's at all; above, the disc is occluded.
  double min_occluded_agreement = 0.35;
  /// Room round the predicted outline in which it is looked for, px; and, with this factor of the
  /// larger semi-axis, for large discs.
  double search_margin_px = 12.0;
  double search_margin_ratio = 0.3;
  /// Largest change of log size between two frames, and the gate of an acquisition in standard
  /// deviations of the prediction.
  double max_scale_step = 0.3;
  double gate_sigmas = 3.5;
  /// Whether to reckon with what rooms and cameras add: a slope of light beside the outline and
  /// levels that are cut off (both are kept out of the fit), discs of which a part is covered (they
  /// are found, and EllipseFeature::visible says so), strong noise, things that only look like a
  /// disc in their middle.
  bool robust = false;
  double min_visible = 0.8;  ///< share of the outline that a covered disc must show
};

/// Tracks a disc: vpDot2 from frame to frame, then the outline is fitted to the grey values by
/// Gauss–Newton, which reaches the Cramér–Rao bound of the centre,
///   σ_c = (σ/C)·√(2 s_b/(√π r)),  s_b = √(s² + 1/12),
/// σ the image noise, C the contrast, r the radius, s the blur. vpDot2 alone is six times worse,
/// and silently wrong when the disc is partly hidden or cut by the border: each frame's outline is
/// judged by sectors. Where vpDot2 loses a faint disc, the tracker's own segmentation takes over.
/// Lens distortion within the disc is ignored.
class DiscTracker : public EllipseTracker {
 public:
  explicit DiscTracker(const DiscTrackerParameters& parameters = {});
  ~DiscTracker() override;

  std::string_view name() const override { return "disc"; }
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
