#pragma once

#include <string>
#include <vector>

namespace vigia {

/// A key that a file may still have under its earlier name. Paths are as `--set` takes them; a
/// world's keys begin with `world.`, a robot's with `robot.`, a campaign's with `campaign.`.
struct RenamedKey {
  std::string before;
  std::string now;
};

/// Every key that was renamed, in the order of the changes; CHANGELOG.md has the same lines.
const std::vector<RenamedKey>& renamed_keys();

/// The present name of the key at @p path, a reader's; nullptr when it was not renamed. A reader
/// of a part alone knows the end of the path only, so a path's end is compared.
const RenamedKey* find_renamed_key(const std::string& path);

}  // namespace vigia
