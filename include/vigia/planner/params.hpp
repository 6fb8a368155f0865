#pragma once

#include "vigia/core/params.hpp"
#include "vigia/planner/fuzzy_supervisors.hpp"
#include "vigia/planner/look_trigger.hpp"
#include "vigia/planner/path_model.hpp"
#include "vigia/planner/perception_plan.hpp"
#include "vigia/planner/route.hpp"
#include "vigia/planner/visibility.hpp"

namespace vigia::planner {

// The keys of the planner's parameters (see ParamVisitor).
void describe(ParamVisitor& v, LookTriggerParams& p);
void describe(ParamVisitor& v, VisibilityParams& p);
void describe(ParamVisitor& v, PathModelParams& p);
void describe(ParamVisitor& v, FuzzyRules& rules);
/// Without the path's model, which has a map of its own.
void describe(ParamVisitor& v, PerceptionParams& p);
/// Without the robot's radius, which is the robot's.
void describe(ParamVisitor& v, RouteParams& p);

}  // namespace vigia::planner
