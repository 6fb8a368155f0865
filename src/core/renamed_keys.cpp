#include "vigia/core/renamed_keys.hpp"

#include <algorithm>

namespace vigia {
namespace {

/// The path with the numbers of list items left out: `walls[2].from_m` is `walls[].from_m`.
std::string without_indices(const std::string& path) {
  std::string plain;
  bool inside = false;
  for (const char c : path) {
    if (c == ']') inside = false;
    if (!inside) plain += c;
    if (c == '[') inside = true;
  }
  return plain;
}

bool ends_with_key(const std::string& path, const std::string& key) {
  if (path.size() < key.size()) return false;
  const std::size_t begin = path.size() - key.size();
  return path.compare(begin, key.size(), key) == 0 && (begin == 0 || path[begin - 1] == '.');
}

}  // namespace

const std::vector<RenamedKey>& renamed_keys() {
  static const std::vector<RenamedKey> keys{
      {"planner.fuzzy.least_value", "planner.fuzzy.min_value"},
      {"planner.fuzzy.least_radius_px", "planner.fuzzy.min_radius_px"},
      {"planner.fuzzy.most_radius_px", "planner.fuzzy.max_radius_px"},
      {"planner.fuzzy.least_feature_px", "planner.fuzzy.min_feature_px"},
      {"disturbances.motion_blur.most_instants", "disturbances.motion_blur.max_instants"},
      {"disturbances.wheel_slip.least_m", "disturbances.wheel_slip.min_m"},
      {"disturbances.wheel_slip.most_m", "disturbances.wheel_slip.max_m"},
      {"disturbances.wheel_slip.least_loss", "disturbances.wheel_slip.min_loss"},
      {"disturbances.wheel_slip.most_loss", "disturbances.wheel_slip.max_loss"},
      {"disturbances.kidnapping.least_m", "disturbances.kidnapping.min_m"},
  };
  return keys;
}

const RenamedKey* find_renamed_key(const std::string& path) {
  const std::string plain = without_indices(path);
  const auto& keys = renamed_keys();
  const auto found = std::find_if(keys.begin(), keys.end(), [&plain](const RenamedKey& key) {
    return ends_with_key(plain, key.before);
  });
  return found != keys.end() ? &*found : nullptr;
}

}  // namespace vigia
