#pragma once

#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/random.hpp"
#include "vigia/localization/points_model.hpp"

namespace vigia::localization::test {

/// A pattern on a wall.
inline Landmark pattern(LandmarkId id, double x, double y, double z, double normal_yaw_deg) {
  return {id, wall_mount({x, y, z}, from_deg(normal_yaw_deg)), PatternShape{{1, 2, 3}}};
}

/// A tag of 0.2 m on a wall.
inline Landmark tag(LandmarkId id, double x, double y, double z, double normal_yaw_deg) {
  return {id, wall_mount({x, y, z}, from_deg(normal_yaw_deg)), TagShape{id, 0.2}};
}

/// The camera of the EVI-D31 at f = 25 mm: 768×576 at 6.25 µm.
inline Intrinsics evi_d31() {
  return {768, 576, 4000.0, 4000.0, 383.5, 287.5, 0.0};
}

/// The points of a landmark as seen from cMl, each with white noise of @p sigma pixels.
inline PointsObservation observe_points(const Landmark& landmark, const Shot& shot,
                                        const Intrinsics& lens, const Eigen::Isometry3d& cMl,
                                        double sigma, RandomStream& random) {
  PointsObservation observation;
  observation.shot = shot;
  observation.expected = landmark.id;
  observation.landmark = landmark.id;
  for (const LandmarkPoint& point : landmark_points(landmark)) {
    const auto image = predict_point(point, lens, cMl);
    const double du = sigma * random.normal();
    const double dv = sigma * random.normal();
    const double stated = sigma > 0.0 ? sigma * sigma : 1e-6;
    observation.points.push_back(
        {point.label, image->uv + Eigen::Vector2d(du, dv), stated * Eigen::Matrix2d::Identity()});
  }
  return observation;
}

inline PointsObservation observe_points(const Landmark& landmark, const Intrinsics& intrinsics,
                                        const Eigen::Isometry3d& cMl, double sigma,
                                        RandomStream& random) {
  Shot shot;
  shot.model = intrinsics;
  return observe_points(landmark, shot, intrinsics, cMl, sigma, random);
}

}  // namespace vigia::localization::test
