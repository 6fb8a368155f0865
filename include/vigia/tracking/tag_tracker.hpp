#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "vigia/tracking/point_tracker.hpp"

namespace vigia::tracking {

struct TagTrackerParameters {
  int max_hamming = 1;                ///< bits of a code that may be wrong
  double min_decision_margin = 20.0;  ///< grey levels between a bit and the decision's border
  double quad_decimate = 1.0;         ///< the detector looks at every n-th pixel
  double search_margin_px = 16.0;
  double gate_sigmas = 3.5;
};

/// Finds, reads and tracks AprilTags of the family 36h11 in grey frames. libapriltag detects and
/// decodes; then each side of the black square is fitted to the grey values in a band along it, and
/// the corners are where the lines meet: two to ten times nearer to the truth than the detector's
/// own. Lens distortion within the tag is ignored.
class TagTracker : public PointTracker {
 public:
  explicit TagTracker(const KnownCodes& known = {}, const TagTrackerParameters& parameters = {});
  ~TagTracker() override;

  std::string_view name() const override { return "tag"; }
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
