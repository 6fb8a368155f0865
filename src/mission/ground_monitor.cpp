#include "ground_monitor.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/core/angle.hpp"
#include "vigia/localization/chi_square.hpp"

namespace vigia::mission {
namespace {

constexpr int kLooksToTell = 3;
constexpr double kTrust = 0.99999;          // that the map is wrong, before it is told
constexpr double kCommonHeight_m = 0.01;    // σ of what all looks of a patch share
const double kCommonTilt = from_deg(0.15);  // the same of the upright

Eigen::Matrix3d crossing(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// The last observation of a tick that a localizer fused.
const Observation* last_fused(const EstimatorTick& tick, const LocalizerTick& localizer) {
  const Observation* last = nullptr;
  for (std::size_t k = 0; k < localizer.updates.size(); ++k)
    if (localizer.updates[k].status == localization::UpdateStatus::fused)
      last = &tick.observations[k];
  return last;
}

}  // namespace

void GroundMonitor::judge(const EstimatorTick& tick) {
  if (ground_.patches().empty()) return;
  const auto in_space =
      std::find_if(tick.localizers.begin(), tick.localizers.end(),
                   [](const LocalizerTick& one) { return one.belief->in_space.has_value(); });
  if (in_space == tick.localizers.end()) return;
  const Observation* fused = last_fused(tick, *in_space);
  if (fused == nullptr) return;
  const LookId look = shot_of(*fused).look;
  if (look != look_ && last_) settle(*last_);
  look_ = look;
  last_ = difference(*in_space->belief);
}

std::optional<GroundMonitor::Difference> GroundMonitor::difference(const Belief& belief) const {
  const Eigen::Isometry3d map = ground_.place(belief.pose);
  const std::size_t patch = ground_.patch_at(belief.pose.position());
  const Eigen::Vector3d upright = map.linear().col(2);
  const bool across_a_fold = (upright - ground_.patches()[patch].wMg.linear().col(2)).norm() > 1e-6;
  if (across_a_fold) return std::nullopt;
  const SpatialPose& seen = *belief.in_space;
  const Eigen::Vector3d seen_upright = seen.wMr.linear().col(2);
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J(0, 2) = 1.0;
  J.bottomRightCorner<2, 3>() = -crossing(seen_upright).topRows<2>();
  Difference of;
  of.patch = patch;
  of.value << seen.wMr.translation().z() - map.translation().z(),
      (seen_upright - upright).head<2>();
  const Eigen::Matrix3d covariance = J * seen.covariance * J.transpose();
  of.information = covariance.ldlt().solve(Eigen::Matrix3d::Identity());
  return of;
}

void GroundMonitor::settle(const Difference& of_look) {
  Sum& sum = sums_[of_look.patch];
  sum.information += of_look.information;
  sum.weighted += of_look.information * of_look.value;
  ++sum.looks;
  if (sum.looks < kLooksToTell || told_.count(of_look.patch) > 0) return;
  Eigen::Matrix3d covariance = sum.information.ldlt().solve(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d mean = covariance * sum.weighted;
  covariance.diagonal() += Eigen::Vector3d(kCommonHeight_m * kCommonHeight_m,
                                           kCommonTilt * kCommonTilt, kCommonTilt * kCommonTilt);
  const double chi2 = mean.dot(covariance.ldlt().solve(mean));
  if (chi2 < localization::chi_square_quantile(kTrust, 3.0)) return;
  told_.insert(of_look.patch);
  const Eigen::Vector2d downhill = ground_.patches()[of_look.patch].wMg.linear().col(2).head<2>();
  const bool ramp = downhill.norm() > 1e-9;
  const Eigen::Vector2d off = mean.tail<2>();
  // On level ground the direction is what the tilt itself has.
  const double steeper = ramp ? off.dot(downhill.normalized()) : off.norm();
  log_.record(EventKind::ground_off, {{"piece", static_cast<double>(of_look.patch + 1)},
                                      {"looks", static_cast<double>(sum.looks)},
                                      {"higher_m", mean[0]},
                                      {"steeper_deg", to_deg(steeper)},
                                      {"chi2", chi2}});
}

}  // namespace vigia::mission
