#pragma once

#include <variant>

#include "vigia/localization/measurement_model.hpp"
#include "vigia/localization/motion.hpp"

namespace vigia::localization {

/// What moves the state of a look on: an increment, or an image whose landmark is known.
using LookInput = std::variant<Motion, Match>;

}  // namespace vigia::localization
