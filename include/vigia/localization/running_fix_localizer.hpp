#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "vigia/localization/corner_filter.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/localization/running_fix.hpp"

namespace vigia::localization {

struct RunningFixLocalizerParams {
  CornerFilterParams pair;  ///< whose calibration's errors the method does not know of
  RunningFixParams fix;
  double min_way_m = 0.10;  ///< between the two points of a fix, at least …
  double max_way_m = 0.60;  ///< … and at most; then the first point is another
  double gate = 16.3;       ///< χ² of a fix's pose against the belief, 0.1 %
  int gated_to_lose = 5;    ///< fixes in a row that do not fit
};

/// The running fix of Bais et al. on a mission: of the corner that is seen nearest the middle of
/// the image, the range now and the range some way ago make two circles, which meet in two
/// candidates. The heading that the displacement takes is the belief's. Between fixes odometry
/// carries the pose; a fix takes its place where it is the better known, its heading of the
/// bearing's and the belief's. Both candidates are carried as hypotheses until a later fix tells
/// them apart. Cameras that look where the robot goes see a corner in much the same direction all
/// the way: fixes come where it turns.
class RunningFixLocalizer final : public Localizer {
 public:
  RunningFixLocalizer(FieldMap field, const RunningFixLocalizerParams& params);

  std::string_view name() const override { return "running_fix"; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;

 private:
  /// A corner that was seen from a first point, and the way since.
  struct First {
    PolarSighting sighting;
    StationMotion since;
  };

  UpdateResult fix(const LandmarkPlace& corner, const First& first, const PolarSighting& second);
  void take(std::vector<PoseHypothesis> weighed);
  void refresh_belief();

  FieldMap field_;
  RunningFixLocalizerParams params_;
  std::vector<PoseHypothesis> poses_;             ///< the likeliest first; none when it is lost
  std::map<std::pair<int, bool>, First> firsts_;  ///< by goal and side
  int gated_ = 0;
  Stamp stamp_;
  Belief belief_;
};

}  // namespace vigia::localization
