#pragma once

#include "vigia/localization/localizer.hpp"

namespace vigia::localization {

/// Dead reckoning: the pose by Armingol eq. 6 (corrected), the covariance by the same motion model
/// as the EKF's. Uses no observation, and cannot start without a prior.
class OdometryLocalizer final : public Localizer {
 public:
  explicit OdometryLocalizer(const OdometryNoise& noise) : noise_(noise) {}

  std::string_view name() const override { return "odometry"; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;

 private:
  OdometryNoise noise_;
  Belief belief_;
};

}  // namespace vigia::localization
