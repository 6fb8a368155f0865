#include "vigia/sim/camera_errors.hpp"

#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

Eigen::Vector3d draw3(RandomStream& random, double sigma) {
  const double x = sigma * random.normal();
  const double y = sigma * random.normal();
  const double z = sigma * random.normal();
  return {x, y, z};
}

}  // namespace

CameraErrors::CameraErrors(const DisturbanceParams& disturbances, std::uint64_t seed) {
  if (disturbances.zoom_calibration) {
    // The mean square over u of a + b cos πu + c cos 2πu is a² + (b² + c²)/2; each third is σ²/3.
    RandomStream random(seed, "zoom calibration");
    const double part = disturbances.zoom_calibration->sigma / std::sqrt(3.0);
    focal_ = draw3(random, part).cwiseProduct(Eigen::Vector3d(1.0, std::sqrt(2.0), std::sqrt(2.0)));
  }
  if (disturbances.principal_point) {
    RandomStream random(seed, "principal point");
    const double direction = random.uniform(-kPi, kPi);
    const double bow = random.uniform(-0.25, 0.25);
    drift_ = disturbances.principal_point->drift_px * unit_vector(direction);
    bow_ = bow * Eigen::Vector2d(-drift_.y(), drift_.x());
  }
  if (disturbances.mounting) {
    RandomStream random(seed, "mounting");
    askew_ = true;
    turn_ = draw3(random, disturbances.mounting->angle);
    offset_ = draw3(random, disturbances.mounting->offset_m);
  }
}

Intrinsics CameraErrors::true_intrinsics(const Intrinsics& calibrated, double u) const {
  Intrinsics truth = calibrated;
  const double error = focal_.dot(Eigen::Vector3d(1.0, std::cos(kPi * u), std::cos(2.0 * kPi * u)));
  truth.px *= 1.0 + error;
  truth.py *= 1.0 + error;
  const Eigen::Vector2d off = drift_ * (u - 0.5) + bow_ * std::sin(2.0 * kPi * u);
  truth.u0 += off.x();
  truth.v0 += off.y();
  return truth;
}

std::optional<Eigen::Isometry3d> CameraErrors::mounting(const Eigen::Vector3d& mount_r) const {
  if (!askew_) return std::nullopt;
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(turn_[0], Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(turn_[1], Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(turn_[2], Eigen::Vector3d::UnitX()));
  return Eigen::Translation3d(mount_r + offset_) * turn * Eigen::Translation3d(-mount_r);
}

}  // namespace vigia::sim
