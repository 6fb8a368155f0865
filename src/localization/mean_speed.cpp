#include "vigia/localization/mean_speed.hpp"

#include <cmath>

namespace vigia::localization {
namespace {

/// The speed is averaged until the distance is known to this share of it …
constexpr double kKnown = 0.03;
/// … but over no longer than this, in which the base may have come to another speed.
constexpr double kMaxAverage_s = 1.2;

double seconds_of(const OdometryIncrement& u) {
  return (u.to - u.from).seconds();
}

}  // namespace

OdometryIncrement MeanSpeed::at_mean_speed(const OdometryIncrement& increment) {
  const double dt = seconds_of(increment);
  if (!(dt > 0.0)) return increment;
  recent_.push_back(increment);
  while ((increment.to - recent_.front().from).seconds() > kMaxAverage_s && recent_.size() > 1)
    recent_.pop_front();
  OdometryIncrement at_mean = increment;
  at_mean.trans = dt * speed();
  return at_mean;
}

double MeanSpeed::speed() const {
  const double variance_per_m = trans_per_sqrt_m_ * trans_per_sqrt_m_;
  double distance = 0.0;
  double duration = 0.0;
  for (auto u = recent_.rbegin(); u != recent_.rend(); ++u) {
    distance += u->trans;
    duration += seconds_of(*u);
    // A reading of exactly nothing is known too: the wheels stand.
    if (variance_per_m * std::abs(distance) <= std::pow(kKnown * distance, 2)) break;
  }
  return distance / duration;
}

}  // namespace vigia::localization
