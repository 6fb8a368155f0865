#pragma once

#include "room_to_move.hpp"

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace vigia::planner {

/// A polyline from @p start to @p goal along which the disc fits, by OMPL's FMT* on @p samples
/// states; empty when none was found. A function of its arguments alone, whatever else uses OMPL
/// and on however many threads.
std::vector<Eigen::Vector2d> search_route(const RoomToMove& room, const Eigen::Vector2d& start,
                                          const Eigen::Vector2d& goal, int samples,
                                          std::uint64_t seed);

}  // namespace vigia::planner
