#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/pose.hpp"
#include "vigia/report/map_picture.hpp"

namespace vigia::report {

/// Distance travelled at each pose, metres; the first is 0.
std::vector<double> travelled_m(const std::vector<Pose2>& poses);

/// √λ_max of the position part of a covariance of (x, y, θ), metres.
double position_sigma_m(const Eigen::Matrix3d& covariance);

/// The instant of each look on the true path: the nearest one, no earlier than that of the look
/// before.
std::vector<std::size_t> look_instants(const std::vector<Pose2>& truth,
                                       const std::vector<MapLook>& looks);

}  // namespace vigia::report
