#include "vigia/core/goal_corner.hpp"

namespace vigia {

std::optional<Eigen::Vector2d> goal_corner_place(const FieldMap& field, const GoalCorner& corner) {
  const FieldGoal* goal = field.goal(corner.goal);
  if (goal == nullptr) return std::nullopt;
  const Eigen::Vector2d mouth = goal->to - goal->from;
  Eigen::Vector2d outwards(-mouth.y(), mouth.x());
  if (outwards.dot(goal->centre()) < 0.0) outwards = -outwards;
  const Eigen::Vector2d leftwards(-outwards.y(), outwards.x());
  return (mouth.dot(leftwards) > 0.0) == corner.left ? goal->to : goal->from;
}

}  // namespace vigia
