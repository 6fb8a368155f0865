#include "vigia/perception/landmark_image.hpp"

#include "vigia/localization/disc_model.hpp"

namespace vigia::perception {

Landmark outline_of(const Landmark& landmark) {
  return {landmark.id, landmark.wMl, DiscShape{extent_radius(landmark)}};
}

std::optional<Ellipse> expected_image(const Shot& shot, const Pose2& pose, const Landmark& landmark,
                                      const RigOnGround& on_ground) {
  return expected_image(shot, on_ground.ground.place(pose), landmark, on_ground.rig);
}

std::optional<Ellipse> expected_image(const Shot& shot, const Eigen::Isometry3d& wMr,
                                      const Landmark& landmark, const Rig& rig) {
  const Eigen::Isometry3d wMc = wMr * rig.at(shot.camera).rMc(shot.head);
  return localization::disc_image(outline_of(landmark), pinhole(shot), wMc);
}

std::optional<ImageMotion> image_motion(const Shot& from, const Pose2& pose_from, const Shot& to,
                                        const Pose2& pose_to, const Landmark& landmark,
                                        const RigOnGround& on_ground) {
  const auto first = expected_image(from, pose_from, landmark, on_ground);
  const auto second = expected_image(to, pose_to, landmark, on_ground);
  if (!first || !second) return std::nullopt;
  return ImageMotion{{second->u - first->u, second->v - first->v}, second->a / first->a};
}

}  // namespace vigia::perception
