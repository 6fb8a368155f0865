#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "vigia/tracking/disc_tracker.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"

namespace vigia::tracking {

struct MovingEdgeTrackerParameters {
  unsigned range_px = 12;       ///< how far along the normal each edge site searches
  double sample_step_px = 3.0;  ///< distance of the sites along the outline
  unsigned mask_size = 5;       ///< of the edge operator, px
  double threshold = 1500.0;    ///< ViSP's likelihood threshold of an edge
  /// Share of the sites that must hold on to the outline, and of the outline that must be a step of
  /// the grey level; less means occlusion.
  double min_good_sites = 0.75;
  /// Smallest share of the outline inside the image; 1 refuses ellipses that the border cuts. (An
  /// arc tells centre and axes poorly, and the covariance does not say how poorly.)
  double min_visible = 1.0;
  double max_scale_step = 0.3;  ///< largest change of log size between two frames
  double gate_sigmas = 3.5;     ///< of an acquisition, in the prediction's standard deviations
  /// Standard deviations of what the tracker is off by, beyond the scatter of its sites: centre and
  /// semi-axes, px. They are measured (see below) and go into the covariance.
  double centre_bias_px = 0.25;
  double axis_bias_px = 0.15;
  DiscTrackerParameters finder;  ///< how acquire and find_all find their seeds, and the polarity
};

/// ViSP's moving-edge ellipse (vpMeEllipse) as a tracker of its own, for comparison. It follows the
/// outline by sites that search along their normals for the strongest edge in whole pixels, which
/// are cut off and not rounded: half a pixel is taken off its centres. What is left, measured on
/// discs of 15 px and contrast 150 under noise 4 from starts up to 2 px beside them: the centre is
/// off by up to 0.23 px rms in each of u and v, the semi-axes by 0.1 to 0.2 px (mean −0.1 px). No
/// averaging over frames takes that away, and the covariance says so. Seeds come from the disc
/// detector.
class MovingEdgeTracker : public EllipseTracker {
 public:
  explicit MovingEdgeTracker(const MovingEdgeTrackerParameters& parameters = {});
  ~MovingEdgeTracker() override;

  std::string_view name() const override { return "ellipse"; }
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
