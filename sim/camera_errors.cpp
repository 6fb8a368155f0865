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

/// Camera 0 draws from the mission's own streams.
std::uint64_t seed_of(std::uint64_t mission_seed, CameraId camera) {
  if (camera == 0) return mission_seed;
  return derive_seed(derive_seed(mission_seed, "camera"), static_cast<std::uint64_t>(camera));
}

struct TrueMount {
  const Eigen::Vector3d& camera_offset_h;
  const std::optional<Eigen::Isometry3d>& askew;

  CameraMount operator()(HeadGeometry head) const {
    head.camera_offset_h += camera_offset_h;
    return head;
  }
  CameraMount operator()(FixedMount fixed) const {
    if (askew) fixed.rMc = *askew * fixed.rMc;
    return fixed;
  }
};

}  // namespace

CameraErrors::CameraErrors(const DisturbanceParams& disturbances, std::uint64_t mission_seed,
                           CameraId camera) {
  const std::uint64_t seed = seed_of(mission_seed, camera);
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
  if (disturbances.mirror) {
    RandomStream random(seed, "mirror");
    mirror_scale_ = disturbances.mirror->scale * random.normal();
    const Eigen::Vector3d centre = draw3(random, disturbances.mirror->centre_px);
    const Eigen::Vector3d tilt = draw3(random, disturbances.mirror->tilt);
    mirror_centre_ = centre.head<2>();
    mirror_tilt_ = tilt.head<2>();
  }
  if (disturbances.mounting) {
    RandomStream random(seed, "mounting");
    askew_ = true;
    turn_ = draw3(random, disturbances.mounting->angle);
    offset_ = draw3(random, disturbances.mounting->offset_m);
    RandomStream optical_centre(seed, "camera offset");
    camera_offset_h_ = draw3(optical_centre, disturbances.mounting->camera_offset_m);
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

void CameraErrors::draw_pair(const StereoParams& pair, std::uint64_t seed, double side) {
  paired_ = true;
  RandomStream random(seed, "stereo");
  const Eigen::Vector3d drawn = draw3(random, 1.0);
  pair_baseline_ = pair.baseline * drawn[0];
  pair_turn_ = -0.5 * side * pair.vergence * drawn[1];
  pair_focal_ = pair.focal * drawn[2];
}

CameraModel CameraErrors::true_model(const CameraModel& calibrated) const {
  constexpr double kMiddle = 0.5;
  if (const auto* pinhole = std::get_if<Intrinsics>(&calibrated)) {
    Intrinsics truth = true_intrinsics(*pinhole, kMiddle);
    truth.px *= 1.0 + pair_focal_;
    truth.py *= 1.0 + pair_focal_;
    return truth;
  }
  UnifiedOmni omni = std::get<UnifiedOmni>(calibrated);
  const Intrinsics plane =
      true_intrinsics({omni.width, omni.height, omni.px, omni.py, omni.u0, omni.v0, 0.0}, kMiddle);
  omni.px = plane.px * (1.0 + mirror_scale_);
  omni.py = plane.py * (1.0 + mirror_scale_);
  omni.u0 = plane.u0 + mirror_centre_.x();
  omni.v0 = plane.v0 + mirror_centre_.y();
  return omni;
}

CameraMount CameraErrors::true_mount(const Camera& known) const {
  const auto* fixed = std::get_if<FixedMount>(&known.mount);
  const auto askew = fixed != nullptr ? mounting(fixed->rMc.translation()) : std::nullopt;
  CameraMount mount = std::visit(TrueMount{camera_offset_h_, askew}, known.mount);
  if (fixed != nullptr && paired_) {
    Eigen::Isometry3d& rMc = std::get<FixedMount>(mount).rMc;
    rMc.translation().y() *= 1.0 + pair_baseline_;
    rMc.linear() =
        Eigen::AngleAxisd(pair_turn_, Eigen::Vector3d::UnitZ()).toRotationMatrix() * rMc.linear();
  }
  const auto* optics = std::get_if<CameraModel>(&known.optics);
  if (optics != nullptr && std::holds_alternative<UnifiedOmni>(*optics) && fixed != nullptr)
    std::get<FixedMount>(mount).rMc.rotate(
        Eigen::AngleAxisd(mirror_tilt_.x(), Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(mirror_tilt_.y(), Eigen::Vector3d::UnitY()));
  return mount;
}

std::optional<Eigen::Isometry3d> CameraErrors::mounting(const Eigen::Vector3d& mount_r) const {
  if (!askew_) return std::nullopt;
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(turn_[0], Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(turn_[1], Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(turn_[2], Eigen::Vector3d::UnitX()));
  return Eigen::Translation3d(mount_r + offset_) * turn * Eigen::Translation3d(-mount_r);
}

}  // namespace vigia::sim
