#pragma once

#include <deque>

#include "vigia/localization/ceiling_filter.hpp"
#include "vigia/localization/localizer.hpp"

namespace vigia::localization {

/// CeilingFilter among the localizers of a mission. A frame that comes late is fused where it was
/// exposed, and the odometry since then goes over it again. A grid without identities cannot say
/// where in it a lost robot is: without a prior it stays lost.
class CeilingLocalizer final : public Localizer {
 public:
  CeilingLocalizer(const CeilingCamera& camera, const CeilingGrid& grid,
                   const CeilingFilterParams& params)
      : filter_(camera, grid, params) {}

  std::string_view name() const override { return "ceiling"; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;

 private:
  /// The filter before an increment of odometry, and that increment.
  struct Step {
    CeilingFilter before;
    OdometryIncrement increment;
  };

  void refresh_belief();

  CeilingFilter filter_;    ///< at the last increment's end
  std::deque<Step> steps_;  ///< of the last second, in order of time
  bool has_prior_ = false;
  Belief belief_;
};

}  // namespace vigia::localization
