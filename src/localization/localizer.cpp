#include "vigia/localization/localizer.hpp"

namespace vigia::localization {

std::string_view to_string(UpdateStatus status) {
  switch (status) {
    case UpdateStatus::fused:
      return "fused";
    case UpdateStatus::gated:
      return "gated";
    case UpdateStatus::ambiguous:
      return "ambiguous";
    case UpdateStatus::degenerate:
      return "degenerate";
    case UpdateStatus::too_late:
      return "too_late";
    case UpdateStatus::unsupported:
      return "unsupported";
    case UpdateStatus::no_prior:
      return "no_prior";
  }
  return "";
}

}  // namespace vigia::localization
