#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "vigia/core/stamp.hpp"
#include "vigia/localization/ceiling_filter.hpp"
#include "vigia/localization/ceiling_model.hpp"
#include "vigia/localization/localizer.hpp"

namespace vigia::localization {

/// Increments between two frames as one, with what the flow says of it. What the camera's tilt and
/// the ceiling's height may miss is taken for noise of the flow. Nothing where flow and odometry
/// exclude each other, in this frame or over the last ones. Of @p params the noise of odometry and
/// flow, tilt, height and gate count.
std::optional<OdometryIncrement> joined_with_flow(const std::vector<OdometryIncrement>& parts,
                                                  const ImageShift& shift,
                                                  const CeilingCamera& camera,
                                                  const CeilingFilterParams& params,
                                                  FlowTrust& trust);

/// Any localizer, moved on by odometry and the flow of a ceiling together. The odometry since the
/// last frame waits for the flow of the next, and the belief goes ahead of it by the odometry
/// alone; whatever else is observed, and a flow that contradicts it, lets it pass as it was read.
/// Tilt and height miss by the same in every frame, and are taken for noise (see
/// joined_with_flow()): over a long way the localizer is too sure by their share.
class FlowFedLocalizer final : public Localizer {
 public:
  /// For a flow.
  static Duration longest_wait() { return Duration::from_seconds(0.5); }

  FlowFedLocalizer(std::unique_ptr<Localizer> fed, const CeilingCamera& camera,
                   const CeilingFilterParams& params);

  std::string_view name() const override { return fed_->name(); }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;

 private:
  std::vector<OdometryIncrement> take_until(Stamp stamp);
  void pass_until(Stamp stamp);
  UpdateResult follow(const FlowObservation& flow);
  void refresh_belief();

  std::unique_ptr<Localizer> fed_;
  CeilingCamera camera_;
  CeilingFilterParams params_;
  FlowTrust trust_;
  std::vector<OdometryIncrement> waiting_;  ///< in order of time
  Belief belief_;
};

}  // namespace vigia::localization
