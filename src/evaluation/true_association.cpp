#include "true_association.hpp"

#include "vigia/core/overloaded.hpp"

namespace vigia::evaluation {
namespace {

const Landmark* nearest_disc(const EllipseObservation& seen, const LandmarkMap& map,
                             const RigOnGround& on_ground, const Pose2& truth,
                             const localization::LookBias& bias) {
  const Landmark* nearest = nullptr;
  double min_px = seen.ellipse.a;
  for (const Landmark& landmark : map.all()) {
    const auto image = localization::predict_disc(landmark, seen.shot, on_ground, truth, bias);
    if (!image) continue;
    const double off_px =
        (image->z.head<2>() - Eigen::Vector2d(seen.ellipse.u, seen.ellipse.v)).norm();
    if (off_px >= min_px) continue;
    min_px = off_px;
    nearest = &landmark;
  }
  return nearest;
}

}  // namespace

const Landmark* true_landmark(const Observation& observation, const LandmarkMap& map,
                              const RigOnGround& on_ground, const Pose2& truth,
                              const localization::LookBias& bias) {
  return std::visit(
      Overloaded{[&](const EllipseObservation& seen) {
                   return nearest_disc(seen, map, on_ground, truth, bias);
                 },
                 [&](const PointsObservation& seen) { return map.find(seen.landmark); }},
      observation);
}

}  // namespace vigia::evaluation
