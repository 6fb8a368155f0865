#pragma once

#include <deque>

#include "vigia/core/odometry.hpp"

namespace vigia::localization {

/// How far successive increments went, for the variance of their errors, which goes with the
/// distance driven. One reading alone does not tell it where an increment is mostly noise: now and
/// then it reads by chance next to nothing, and a filter that believed it would take that reading
/// for exact. There the mean speed of the last readings stands for it.
class MeanSpeed {
 public:
  explicit MeanSpeed(const OdometryNoise& noise) : trans_per_sqrt_m_(noise.trans_per_sqrt_m) {}

  void reset() { recent_.clear(); }

  /// @p increment, which follows the one of the last call, with the distance at the mean speed.
  OdometryIncrement at_mean_speed(const OdometryIncrement& increment);

 private:
  double speed() const;

  double trans_per_sqrt_m_;
  std::deque<OdometryIncrement> recent_;
};

}  // namespace vigia::localization
