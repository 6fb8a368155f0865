#pragma once

#include <deque>

#include "vigia/core/stamp.hpp"
#include "vigia/localization/ceiling_filter.hpp"
#include "vigia/localization/localizer.hpp"

namespace vigia::localization {

/// CeilingFilter among the localizers of a mission. A frame that comes late is fused where it was
/// exposed, and the odometry since then goes over it again; a flow is fused with the odometry
/// between its frames, wherever an increment ends at each of them. A grid without identities cannot
/// say where in it a lost robot is: without a prior it stays lost.
class CeilingLocalizer final : public Localizer {
 public:
  /// How late an image may come.
  static Duration history() { return Duration::from_seconds(1.0); }

  /// @p flow: whether the ceiling's flow moves it, too.
  CeilingLocalizer(const CeilingCamera& camera, const CeilingGrid& grid,
                   const CeilingFilterParams& params, bool flow = true)
      : filter_(camera, grid, params), uses_flow_(flow) {}

  std::string_view name() const override { return "ceiling"; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;

 private:
  /// The filter before an increment of odometry, that increment, and the flow meanwhile.
  struct Step {
    CeilingFilter before;
    OdometryIncrement increment;
    std::optional<ImageShift> flow = std::nullopt;
  };
  using Steps = std::deque<Step>;

  UpdateResult fuse(const PatchesObservation& seen);
  UpdateResult follow(const FlowObservation& flow);
  bool repeat(const Steps::iterator& from, CeilingFilter filter);
  void refresh_belief();

  CeilingFilter filter_;  ///< at the last increment's end
  Steps steps_;           ///< of the last second, in order of time
  bool uses_flow_;
  bool has_prior_ = false;
  Belief belief_;
};

}  // namespace vigia::localization
