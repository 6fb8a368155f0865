#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "vigia/core/rig.hpp"
#include "vigia/core/stamp.hpp"
#include "vigia/localization/field_tracker.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/localization/mcl.hpp"
#include "vigia/localization/mirror_self_calibration.hpp"
#include "vigia/localization/murea.hpp"

namespace vigia::localization {

/// The mirror cameras of a robot, whose errors are to be estimated.
struct MirrorOfRig {
  Rig rig;
  MirrorErrorParams errors;
};

/// What all localizers on scans of a field have in common: other observations are unsupported, a
/// scan without points is degenerate, and a late one is carried to the present by the odometry
/// since its exposure, whose error in so short a time is small beside the scan's.
///
/// A mirror camera's errors are estimated beside the pose (MirrorSelfCalibration) where the robot's
/// rig is given: a method gets the scans as these errors leave them, and the belief's covariance
/// has what is not known of them beside the method's own.
class FieldLocalizer : public Localizer {
 public:
  /// How late an image may come.
  static Duration history() { return Duration::from_seconds(1.0); }

  const Belief& belief() const final { return belief_; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) final;
  void predict(const OdometryIncrement& increment) final;
  UpdateResult update(const Observation& observation) final;
  /// Forgets where it is; it can find itself.
  void lose() final;

 protected:
  /// @p model outlives this.
  void calibrate(const FieldModel& model, const MirrorOfRig& mirror, const OdometryNoise& odometry);
  virtual const Belief& own_belief() const = 0;
  virtual void start(Stamp stamp, const std::optional<Prior>& prior) = 0;
  virtual void move_by(const OdometryIncrement& increment) = 0;
  virtual void take(const FieldScan& scan) = 0;

 private:
  struct Place {
    Stamp stamp;
    Pose2 oMr;  ///< by odometry
  };
  void process(const FieldObservation& seen, const Pose2& now_from_then);
  void refresh();

  std::deque<Place> places_;  ///< of the last second, in order of time
  std::optional<MirrorOfRig> mirror_;
  std::optional<MirrorSelfCalibration> calibration_;
  Belief belief_;
};

/// The field is copied; each localizer has its own. Without a @p mirror its calibration counts as
/// right.
std::unique_ptr<FieldLocalizer> make_field_tracker(
    const FieldMap& field, const FieldTrackerParams& params,
    const std::optional<MirrorOfRig>& mirror = std::nullopt);
std::unique_ptr<FieldLocalizer> make_mcl(const FieldMap& field, const MclParams& params,
                                         std::uint64_t seed,
                                         const std::optional<MirrorOfRig>& mirror = std::nullopt);
std::unique_ptr<FieldLocalizer> make_murea(const FieldMap& field,
                                           const MureaLocalizerParams& params,
                                           const std::optional<MirrorOfRig>& mirror = std::nullopt);

}  // namespace vigia::localization
