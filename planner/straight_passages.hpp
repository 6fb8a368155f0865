#pragma once

#include "room_to_move.hpp"

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace vigia::planner {

/// Plans a polyline between two points; empty when there is none.
using LegPlanner =
    std::function<std::vector<Eigen::Vector2d>(const Eigen::Vector2d&, const Eigen::Vector2d&)>;

/// @p leg, going through the middle of each of its passages (see find_passages) straight: from a
/// place before it, where a robot has room to turn, to one behind it. Passages that it goes through
/// so already, those at its ends and those without such places before and behind them stay as they
/// are. @p plan joins the pieces; @p reach_m is what the robot's middle keeps from faces elsewhere.
std::vector<Eigen::Vector2d> with_straight_passages(const RoomToMove& body,
                                                    std::vector<Eigen::Vector2d> leg,
                                                    double reach_m, const LegPlanner& plan);

}  // namespace vigia::planner
