#include "look_around.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/servo/slew_law.hpp"

namespace vigia::mission {
namespace {

constexpr double kAtStop = from_deg(0.3);
constexpr double kAtRest = from_deg(0.5);  // per second
constexpr double kFarther = 1.5;  // times the focal length, of the next sweep from one place
constexpr int kLenses = 3;        // that are tried in turn
constexpr double kFromStop = from_deg(3);  // an encoder that is a little off may never read the end

}  // namespace

void LookAround::begin(const HeadReading& head, bool again) {
  const auto& limits = setup_.robot.robot.head_limits;
  const ZoomCalibration& zoom = setup_.robot.zoom();
  repeats_ = again ? repeats_ + 1 : 0;
  zoom_mm_ =
      std::min(zoom.min_zoom_mm() * std::pow(kFarther, repeats_ % kLenses), zoom.max_zoom_mm());
  const Intrinsics lens = zoom.at(zoom_mm_);
  const double field = 2.0 * std::atan(0.5 * lens.width / lens.px);
  const double step = setup_.recovery.step_fraction * field;
  const double first = limits.pan_min + kFromStop;
  const double span = limits.pan_max - kFromStop - first;
  const int count = 1 + static_cast<int>(std::ceil(span / step));
  stops_.clear();
  for (int i = 0; i < count; ++i)
    stops_.push_back({first + span * i / (count - 1), setup_.recovery.tilt});
  if (head.angles.pan > 0.5 * (limits.pan_min + limits.pan_max))
    std::reverse(stops_.begin(), stops_.end());
  stop_ = 0;
  settled_since_.reset();
  ++sweeps_;
}

HeadRates LookAround::step(const HeadReading& head) const {
  const auto& limits = setup_.robot.robot.head_limits;
  const HeadAngles& aim = stops_[stop_];
  HeadRates rates;
  const servo::SlewLaw law{limits.rate, limits.acceleration, setup_.gaze.aim_gain, setup_.tick_s};
  rates.angles.pan = law.rate_for(aim.pan - head.angles.pan);
  rates.angles.tilt = law.rate_for(aim.tilt - head.angles.tilt);
  const double zoom_error = zoom_mm_ - head.zoom_mm;
  rates.zoom_mm_s =
      std::clamp(zoom_error / setup_.tick_s, -limits.zoom_rate_mm_s, limits.zoom_rate_mm_s);
  return rates;
}

bool LookAround::ready(Stamp now, const HeadReading& head, Stamp exposed) {
  const HeadAngles& aim = stops_[stop_];
  const bool there = std::abs(aim.pan - head.angles.pan) < kAtStop &&
                     std::abs(aim.tilt - head.angles.tilt) < kAtStop &&
                     std::abs(head.rates.pan) < kAtRest && std::abs(head.rates.tilt) < kAtRest &&
                     std::abs(head.zoom_mm - zoom_mm_) < 0.01;
  if (!there) {
    settled_since_.reset();
    return false;
  }
  if (!settled_since_) settled_since_ = now;
  return exposed - *settled_since_ >= Duration::from_seconds(setup_.recovery.settle_s);
}

bool LookAround::next() {
  settled_since_.reset();
  return ++stop_ < stops_.size();
}

}  // namespace vigia::mission
