#pragma once

#include <optional>

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/rig.hpp"

namespace vigia::perception {

/// The circle that holds a landmark's features, as a disc.
Landmark outline_of(const Landmark& landmark);

/// Image of a landmark's outline in a shot that was exposed at @p pose; nothing when it has none.
std::optional<Ellipse> expected_image(const Shot& shot, const Pose2& pose, const Landmark& landmark,
                                      const RigOnGround& on_ground);

/// The same of a robot that stands at wMr.
std::optional<Ellipse> expected_image(const Shot& shot, const Eigen::Isometry3d& wMr,
                                      const Landmark& landmark, const Rig& rig);

/// How a landmark's image moves between two shots.
struct ImageMotion {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< px
  double growth = 1.0;                              ///< of the semi-major axis
};

/// The motion of a landmark's image from a shot exposed at one pose to a shot exposed at another;
/// nothing when it has no image in either.
std::optional<ImageMotion> image_motion(const Shot& from, const Pose2& pose_from, const Shot& to,
                                        const Pose2& pose_to, const Landmark& landmark,
                                        const RigOnGround& on_ground);

}  // namespace vigia::perception
