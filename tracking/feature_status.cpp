#include "vigia/tracking/feature_status.hpp"

namespace vigia::tracking {

std::string_view to_string(FeatureStatus status) {
  switch (status) {
    case FeatureStatus::found:
      return "found";
    case FeatureStatus::not_found:
      return "not_found";
    case FeatureStatus::occluded:
      return "occluded";
    case FeatureStatus::cut_by_border:
      return "cut_by_border";
    case FeatureStatus::wrong_object:
      return "wrong_object";
    case FeatureStatus::low_contrast:
      return "low_contrast";
    case FeatureStatus::unreadable:
      return "unreadable";
    case FeatureStatus::unknown_code:
      return "unknown_code";
  }
  return "unknown";
}

}  // namespace vigia::tracking
