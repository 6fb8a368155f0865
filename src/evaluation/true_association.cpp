#include "true_association.hpp"

#include <cmath>

#include "vigia/core/overloaded.hpp"

namespace vigia::evaluation {
namespace {

const Landmark* nearest_disc(const EllipseObservation& seen, const LandmarkMap& map,
                             const RigOnGround& on_ground, const Pose2& truth,
                             const localization::LookBias& bias) {
  const Shot& shot = seen.shot;
  const HeadAngles head{shot.head.pan + bias.pan, shot.head.tilt + bias.tilt};
  const Eigen::Isometry3d cMw = on_ground.wMc(shot.camera, head, truth).inverse();
  Intrinsics camera = pinhole(shot);
  camera.px *= std::exp(bias.log_focal);
  camera.py *= std::exp(bias.log_focal);
  const Eigen::Vector2d uv(seen.ellipse.u, seen.ellipse.v);
  const Landmark* nearest = nullptr;
  double min_px = seen.ellipse.a;
  for (const Landmark& landmark : map.all()) {
    if (!std::holds_alternative<DiscShape>(landmark.shape)) continue;
    const auto image = project(camera, cMw * landmark.centre_w());
    if (!image || (*image - uv).norm() >= min_px) continue;
    min_px = (*image - uv).norm();
    nearest = &landmark;
  }
  return nearest;
}

}  // namespace

const Landmark* true_landmark(const Observation& observation, const LandmarkMap& map,
                              const RigOnGround& on_ground, const Pose2& truth,
                              const localization::LookBias& bias) {
  const auto image = landmark_image(observation);
  if (!image) return nullptr;
  return std::visit(
      Overloaded{[&](const EllipseObservation* seen) {
                   return nearest_disc(*seen, map, on_ground, truth, bias);
                 },
                 [&](const PointsObservation* seen) { return map.find(seen->landmark); }},
      *image);
}

}  // namespace vigia::evaluation
