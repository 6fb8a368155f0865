#pragma once

#include <string>

#include "vigia/core/ground.hpp"
#include "vigia/core/stamp.hpp"

namespace vigia::mission {

/// A line of a TUM trajectory, `stamp x y z qx qy qz qw`, of a robot that stands on the ground;
/// with its end of line.
std::string tum_line(Stamp stamp, const Pose2& pose, const Ground& ground);
/// The same of a pose in space.
std::string tum_line(Stamp stamp, const Eigen::Isometry3d& wMr);

}  // namespace vigia::mission
