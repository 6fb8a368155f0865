#pragma once

#include "localization/drive.hpp"
#include "localization/points_views.hpp"

#include <string_view>
#include <utility>
#include <vector>

namespace vigia::localization::test {

/// The room's landmarks with patterns (even ids) and tags (odd ids) where the discs were.
inline LandmarkMap room_points() {
  std::vector<Landmark> landmarks = room_landmarks().all();
  for (Landmark& landmark : landmarks) {
    if (landmark.id % 2 == 0)
      landmark.shape = PatternShape{{1, landmark.id, 0}};
    else
      landmark.shape = TagShape{landmark.id, 0.2};
  }
  return LandmarkMap(landmarks);
}

/// The points of a landmark as the head saw them from @p truth: its true angles and focal length
/// are those of @p sensor with the look's bias and a white part.
inline PointsObservation observe_points(const Landmark& landmark, const Shot& shot,
                                        const HeadGeometry& geometry, const Eigen::Isometry3d& wMr,
                                        const LookBias& bias, double reading_angle,
                                        double pixel_sigma, RandomStream& random) {
  HeadAngles head{shot.head.pan + bias.pan, shot.head.tilt + bias.tilt};
  head.pan += reading_angle * random.normal();
  head.tilt += reading_angle * random.normal();
  Intrinsics lens = pinhole(shot);
  lens.px *= std::exp(bias.log_focal);
  lens.py *= std::exp(bias.log_focal);
  const Eigen::Isometry3d wMc = wMr * camera_in_base(geometry, head);
  return observe_points(landmark, shot, lens, wMc.inverse() * landmark.wMl, pixel_sigma, random);
}

/// What a drive's looks would have seen with patterns and tags in place of the discs, one entry a
/// step.
inline std::vector<std::optional<PointsObservation>> points_of(const Drive& drive,
                                                               std::uint64_t seed) {
  RandomStream random(seed, "points");
  const LandmarkMap map = room_points();
  std::vector<std::optional<PointsObservation>> seen;
  for (const DriveStep& step : drive.steps) {
    seen.emplace_back();
    if (step.seen)
      seen.back() = observe_points(
          *map.find(*step.seen->expected), step.seen->shot, drive.geometry, to_isometry(step.pose),
          step.bias, drive.noise.sensor.reading_angle, drive.noise.pixel_sigma, random);
  }
  return seen;
}

}  // namespace vigia::localization::test
