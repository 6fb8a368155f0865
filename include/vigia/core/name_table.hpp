#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace vigia {

/// What a table of names says of each: localizers, trackers, policies and eyes are told apart by
/// name, each kind in one list of entries that derive from this and say how one is made.
struct NameEntry {
  std::string name;
  std::string meaning;
  std::string needs;  ///< of the world and the robot's rig
};

template <typename Entry>
std::vector<std::string> names_of(const std::vector<Entry>& entries) {
  std::vector<std::string> names;
  names.reserve(entries.size());
  for (const Entry& entry : entries) names.push_back(entry.name);
  return names;
}

/// Null for a name that is not in the table.
template <typename Entry>
const Entry* find_name(const std::vector<Entry>& entries, const std::string& name) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&name](const Entry& entry) { return entry.name == name; });
  return found != entries.end() ? &*found : nullptr;
}

}  // namespace vigia
