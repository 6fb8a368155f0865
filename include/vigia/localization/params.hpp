#pragma once

#include "vigia/core/params.hpp"
#include "vigia/localization/bearing_only.hpp"
#include "vigia/localization/ceiling_filter.hpp"
#include "vigia/localization/ekf.hpp"

namespace vigia::localization {

// The keys of the localizers' parameters (see ParamVisitor).
/// The noise that the caller has set is the default: the mission's.
void describe(ParamVisitor& v, EkfParams& p);
void describe(ParamVisitor& v, BearingOnlyParams& p);
void describe(ParamVisitor& v, CeilingFilterParams& p);

}  // namespace vigia::localization
