#pragma once

#include "vigia/core/params.hpp"
#include "vigia/localization/ekf.hpp"

namespace vigia::localization {

// The keys of the localizers' parameters (see ParamVisitor).
/// The noise that the caller has set is the default: the robot's.
void describe(ParamVisitor& v, EkfParams& p);

}  // namespace vigia::localization
