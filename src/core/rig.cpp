#include "vigia/core/rig.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace vigia {
namespace {

Eigen::Isometry3d placed(const HeadGeometry& mount, const HeadAngles& head) {
  return camera_in_base(mount, head);
}

Eigen::Isometry3d placed(const FixedMount& mount, const HeadAngles& /*head*/) {
  return mount.rMc;
}

std::optional<ZoomCalibration> calibration_of(const ZoomCalibration& zoom) {
  return zoom;
}

std::optional<ZoomCalibration> calibration_of(const CameraModel& model) {
  const auto* k = std::get_if<Intrinsics>(&model);
  if (k == nullptr) return std::nullopt;
  return ZoomCalibration(k->width, k->height, k->u0, k->v0, {{0.0, k->px, k->kdu}});
}

CameraModel focused(const ZoomCalibration& optics, double zoom_mm) {
  return optics.at(zoom_mm);
}

CameraModel focused(const CameraModel& optics, double /*zoom_mm*/) {
  return optics;
}

}  // namespace

Eigen::Isometry3d mounted_camera(const CameraMount& mount, const HeadAngles& head) {
  return std::visit([&](const auto& on) { return placed(on, head); }, mount);
}

Eigen::Isometry3d Camera::rMc(const HeadAngles& head) const {
  return mounted_camera(mount, head);
}

CameraModel Camera::model(double zoom_mm) const {
  return std::visit([&](const auto& by) { return focused(by, zoom_mm); }, optics);
}

std::optional<ZoomCalibration> zoom_calibration(const Optics& optics) {
  return std::visit([](const auto& by) { return calibration_of(by); }, optics);
}

bool looks_up(const Camera& camera) {
  const auto* fixed = std::get_if<FixedMount>(&camera.mount);
  const auto* model = std::get_if<CameraModel>(&camera.optics);
  return fixed != nullptr && model != nullptr && std::holds_alternative<Intrinsics>(*model) &&
         fixed->rMc.linear()(2, 2) > std::sqrt(0.5);
}

bool on_head(const Camera& camera) {
  return std::holds_alternative<HeadGeometry>(camera.mount);
}

const Camera* directed_camera(const Rig& rig) {
  const auto found = std::find_if(rig.cameras.begin(), rig.cameras.end(), [](const Camera& camera) {
    return on_head(camera) && zoom_calibration(camera.optics).has_value();
  });
  return found == rig.cameras.end() ? nullptr : &*found;
}

std::optional<StereoCameras> stereo_cameras(const Rig& rig) {
  constexpr double kAlike = 1e-9;
  if (rig.cameras.size() != 2) return std::nullopt;
  const Camera* const left = &rig.cameras[0];
  const Camera* const right = &rig.cameras[1];
  for (const Camera* camera : {left, right}) {
    const auto* fixed = std::get_if<FixedMount>(&camera->mount);
    const auto* model = std::get_if<CameraModel>(&camera->optics);
    if (fixed == nullptr || model == nullptr || !std::holds_alternative<Intrinsics>(*model) ||
        !fixed->rMc.linear().isApprox(head_from_camera(), kAlike))
      return std::nullopt;
  }
  const auto place = [](const Camera* camera) {
    return Eigen::Vector3d(std::get<FixedMount>(camera->mount).rMc.translation());
  };
  const auto lens = [](const Camera* camera) {
    return std::get<Intrinsics>(std::get<CameraModel>(camera->optics));
  };
  const Eigen::Vector3d mirrored = place(right).cwiseProduct(Eigen::Vector3d(1.0, -1.0, 1.0));
  const Intrinsics k = lens(left);
  const Intrinsics other = lens(right);
  if ((place(left) - mirrored).norm() > kAlike || place(left).y() < kAlike || k.px != other.px ||
      k.u0 != other.u0 || k.v0 != other.v0 || k.kdu != other.kdu || k.width != other.width ||
      k.height != other.height || left->period_s != right->period_s ||
      left->phase_s != right->phase_s || left->latency_s != right->latency_s)
    return std::nullopt;
  return StereoCameras{left->id,        right->id,       2.0 * place(left).y(),
                       place(left).x(), place(left).z(), k};
}

const Camera* Rig::find(CameraId id) const {
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [id](const Camera& camera) { return camera.id == id; });
  return found == cameras.end() ? nullptr : &*found;
}

const Camera& Rig::at(CameraId id) const {
  if (const Camera* camera = find(id)) return *camera;
  throw std::out_of_range("the rig has no camera " + std::to_string(id));
}

Rig head_rig(const HeadGeometry& geometry, Optics optics) {
  Camera camera;
  camera.mount = geometry;
  camera.optics = std::move(optics);
  return {{std::move(camera)}};
}

}  // namespace vigia
