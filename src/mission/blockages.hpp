#pragma once

#include <utility>
#include <vector>

#include "vigia/core/round_obstacle.hpp"
#include "vigia/core/stamp.hpp"

namespace vigia::mission {

/// What blocked the path lately and is kept out of the next routes, long after the pilot's ring has
/// lost sight of it.
class Blockages {
 public:
  /// Adds things that block now; those noted before in the same places are replaced.
  void note(Stamp now, const std::vector<RoundObstacle>& things);
  /// What was noted within the last minute.
  std::vector<RoundObstacle> recent(Stamp now) const;

 private:
  std::vector<std::pair<Stamp, RoundObstacle>> things_;
};

}  // namespace vigia::mission
