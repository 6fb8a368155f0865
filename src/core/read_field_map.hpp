#pragma once

#include "vigia/core/field_map.hpp"
#include "vigia/core/params.hpp"

namespace vigia {

/// The keys of the block `field`; see read_field_map().
void describe(ParamVisitor& v, FieldMap& map);

}  // namespace vigia
