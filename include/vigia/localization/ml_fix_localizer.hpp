#pragma once

#include <deque>
#include <vector>

#include "vigia/core/stamp.hpp"
#include "vigia/localization/corner_filter.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/localization/station_fix.hpp"

namespace vigia::localization {

struct MlFixParams {
  CornerFilterParams filter;
  int stations = 16;       ///< sightings that a fix without a prior is made from, at most
  int gated_to_lose = 10;  ///< pairs of images in a row of which nothing fits
};

/// Maximum likelihood of range and bearing of goals' corners on a mission: station_fix() over the
/// drive so far where it does not know where it is, then its recursive form, CornerFilter, with the
/// errors of calibration as states. A fix without a prior takes two different corners: by one, body
/// odometry does not tell the heading. A pair of images that comes late is fused where it was
/// exposed; without a fix it is let go.
class MlFixLocalizer final : public Localizer {
 public:
  /// How late an image may come.
  static Duration history() { return Duration::from_seconds(1.0); }

  MlFixLocalizer(FieldMap field, const MlFixParams& params);

  std::string_view name() const override { return "ml_fix"; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;
  StereoErrors calibration() const { return filter_.calibration(); }

 private:
  /// The filter before an increment of odometry, and that increment.
  struct Step {
    CornerFilter before;
    OdometryIncrement increment;
  };

  UpdateResult track(const StereoObservation& seen);
  UpdateResult search(const StereoObservation& seen);
  void refresh_belief();

  FieldMap field_;
  MlFixParams params_;
  CornerFilter filter_;
  std::deque<Step> steps_;  ///< of the last second, in order of time
  bool found_ = false;
  int gated_ = 0;        ///< pairs of images in a row
  StationChain chain_;   ///< while it does not know where it is
  StationMotion since_;  ///< the chain's last sighting
  Stamp stamp_;
  Belief belief_;
};

}  // namespace vigia::localization
