#pragma once

#include <memory>

#include "vigia/planner/look_policy.hpp"

namespace vigia::planner {

/// The policy "fuzzy": the perception planner of Armingol et al. In motion the second supervisor
/// picks among the landmarks that the plan has preselected for the control area in which the head
/// will arrive, at the area's zoom, unless another that is visible suits the uncertainty better.
/// Standing, it takes the landmark that allows the best adjustment of the zoom, and landmarks along
/// both axes in turn while both are uncertain.
std::unique_ptr<LookPolicy> make_fuzzy_policy(const LookPolicyParts& parts);

}  // namespace vigia::planner
