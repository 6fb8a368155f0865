#pragma once

#include <optional>

#include <Eigen/Core>

#include "vigia/core/field_map.hpp"

namespace vigia {

/// One end of a goal's mouth, as it is named from the field.
struct GoalCorner {
  FieldColour goal = FieldColour::yellow;
  bool left = true;  ///< whether the goal begins on its right
};

/// Where the map has it; nothing where the field has no such goal.
std::optional<Eigen::Vector2d> goal_corner_place(const FieldMap& field, const GoalCorner& corner);

/// A goal's corner in both images of a stereo pair.
struct StereoCorner {
  GoalCorner corner;
  Eigen::Vector2d left_uv = Eigen::Vector2d::Zero();
  Eigen::Vector2d right_uv = Eigen::Vector2d::Zero();
  /// Of the columns in the left and the right image, px². Rows say nothing but where the edge was
  /// seen.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};

}  // namespace vigia
