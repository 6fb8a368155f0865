#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vigia/tracking/point_tracker.hpp"

namespace vigia::tracking {

/// The tag families that are known: "36h11", "25h9", "16h5" and "Standard41h12".
std::vector<std::string> tag_families();

struct TagTrackerParams {
  std::string family = "36h11";  ///< one of tag_families()
  /// Bits of a code that may be wrong; short families allow fewer (25h9 one, 16h5 none).
  int max_hamming = 1;
  /// Grey levels between a bit and the decision's border; short families ask for more.
  double min_decision_margin = 20.0;
  double quad_decimate = 1.0;  ///< the detector looks at every n-th pixel
  double search_margin_px = 16.0;
  double gate_sigmas = 3.5;
};

/// Finds, reads and tracks AprilTags in grey frames. libapriltag detects and decodes; then the
/// whole print of that tag is fitted to the grey values: homography, levels, a slope of the light,
/// blur, and the camera's response. So a corner is as good as all edges of the tag make it, needs
/// half a field of white rim, and agrees with the code's grid. Fields that disagree with the print
/// make the tag occluded where they are the border's or more than max_hamming. A tracked tag is
/// fitted from where it was expected, which reads its code as well; the detector is asked only when
/// that fails. Lens distortion within the tag is ignored.
class TagTracker : public PointTracker {
 public:
  explicit TagTracker(const KnownCodes& known = {}, const TagTrackerParams& parameters = {});
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
