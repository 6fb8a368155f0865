#include "target_motion.hpp"

namespace vigia::tracking {

double TargetMotion::reach(double size) const {
  constexpr double kUnknown = 24.0;  // px a picture, at a velocity that is not known
  constexpr double kChange = 10.0;   // px by which a known velocity takes it off in one picture
  constexpr double kAging = 4.0;     // px for each further picture
  const double first = moving_ ? kChange + 0.3 * velocity_.norm() : kUnknown;
  return first + 0.5 * size + kAging * (unseen_ - 1);
}

void TargetMotion::see(const Eigen::Vector2d& at) {
  if (unseen_ > 0) {
    velocity_ = (at - seen_) / unseen_;
    moving_ = true;
  }
  seen_ = at;
  unseen_ = 0;
}

}  // namespace vigia::tracking
