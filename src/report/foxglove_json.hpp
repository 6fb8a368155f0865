#pragma once

#include "palette.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "vigia/core/stamp.hpp"

/// What the messages of Foxglove's schemas are made of.
namespace vigia::report::foxglove {

using Json = nlohmann::ordered_json;

/// To a millionth of its unit, which a viewer cannot show.
Json number_json(double value);
Json time_json(Stamp at);
Json point_json(const Eigen::Vector2d& p);
Json point_json(const Eigen::Vector3d& p);
Json pose_json(const Eigen::Isometry3d& aMb);
Json colour_json(const Colour& colour);
/// In UTF-8; what is none is replaced.
std::string text_of(const Json& message);

}  // namespace vigia::report::foxglove
