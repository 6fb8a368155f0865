#pragma once

#include <memory>

#include "vigia/planner/look_policy.hpp"

namespace vigia::planner {

/// The policy "greedy": the landmark that leaves the least expected trace of the position's
/// covariance after the look, judged where the robot will be when head and zoom have arrived.
std::unique_ptr<LookPolicy> make_greedy_policy();

}  // namespace vigia::planner
