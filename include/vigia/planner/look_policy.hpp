#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vigia/core/actuation.hpp"
#include "vigia/core/belief.hpp"
#include "vigia/core/information.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/random.hpp"
#include "vigia/planner/visibility.hpp"

namespace vigia::planner {

/// What a policy knows when it is asked.
struct LookContext {
  Stamp now;
  const Belief& belief;
  const HeadReading& head;
  double station_m = 0.0;  ///< arc length reached on the path
  const Path& path;
  const LandmarkMap& landmarks;
  const Visibility& visibility;
  const InformationModel& information;
  /// Landmarks that failed lately (not acquired), to be left out.
  const std::vector<LandmarkId>& excluded;
};

/// Chooses which landmark to watch next.
class LookPolicy {
 public:
  virtual ~LookPolicy() = default;
  virtual std::string_view name() const = 0;
  /// The landmark to look at from where the robot believes to be, or nothing when none will do.
  virtual std::optional<LandmarkId> choose(const LookContext& context) = 0;
};

/// "fixed" (the landmark @p fixed), "random" (visible ones, drawn from @p stream), "nearest"
/// (visible), or "pattern" (QUIXOTE's three criteria). Null for another name.
std::unique_ptr<LookPolicy> make_look_policy(const std::string& name,
                                             std::optional<LandmarkId> fixed, RandomStream stream);

/// The names that make_look_policy knows.
std::vector<std::string> look_policy_names();

}  // namespace vigia::planner
