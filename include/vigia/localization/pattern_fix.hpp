#pragma once

#include <array>
#include <deque>

#include "vigia/localization/localizer.hpp"
#include "vigia/localization/spatial_pose.hpp"

namespace vigia::localization {

struct PatternFixParams {
  OdometryNoise odometry;
  SensorNoise sensor;
  PointsPoseParams pose;            ///< its frontal_below is the φ under which a view is rejected
  double gate_probability = 0.999;  ///< of the dots' scatter about the fitted pose
  /// A robot on its wheels is not steeper than this: of a view and its twin the one that stands
  /// upright is taken.
  double max_slope = 0.2617993877991494;  ///< rad, 15°
  double history_s = 1.0;                 ///< how late an observation may be
};

/// QUIXOTE's localizer (Adán §3, with the refined pose): each image of a colour pattern gives the
/// robot's whole pose in space and replaces what was believed before; between the looks it holds
/// with odometry. The planar belief is that pose seen from above.
///
/// It needs no prior: lost, it is found by the next pattern that it fuses.
///
/// Results of update(): `fused`; `gated` when the pattern is not of the map or its dots scatter
/// more than their noise; `degenerate` for too few dots or a frontal view (φ < 25°); `ambiguous`
/// when view and twin explain the dots alike and both stand upright; `unsupported` for discs and
/// tags.
class PatternFixLocalizer final : public Localizer {
 public:
  PatternFixLocalizer(LandmarkMap map, const RigOnGround& on_ground,
                      const PatternFixParams& params);

  std::string_view name() const override { return "pattern_fix"; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;

  /// How many updates ended with this status since the construction.
  int count(UpdateStatus status) const { return counts_[static_cast<std::size_t>(status)]; }

 private:
  UpdateResult process(const PointsObservation& observation);
  const FittedPose* upright(const PointsPose& solved, const Landmark& landmark,
                            const Shot& shot) const;
  void believe(const SpatialPose& pose, Stamp stamp);

  LandmarkMap map_;
  RigOnGround on_ground_;
  PatternFixParams params_;
  Belief belief_;
  Stamp start_;
  std::deque<OdometryIncrement> history_;
  std::array<int, kUpdateStatuses> counts_{};
};

}  // namespace vigia::localization
