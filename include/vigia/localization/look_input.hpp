#pragma once

#include <variant>

#include "vigia/localization/measurement_model.hpp"
#include "vigia/localization/motion.hpp"

namespace vigia::localization {

template <typename Matches>
struct MotionOr;
template <typename... Matches>
struct MotionOr<std::variant<Matches...>> {
  using type = std::variant<Motion, Matches...>;
};

/// What moves the state of a look on: an increment, or an image whose landmark is known.
using LookInput = MotionOr<Match>::type;

}  // namespace vigia::localization
