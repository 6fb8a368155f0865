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
#include "vigia/core/name_table.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/random.hpp"
#include "vigia/planner/perception_plan.hpp"
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
  const HeadModel& head_model;
  double speed_mps = 0.0;         ///< of the base, now
  bool standing = false;          ///< the robot has stopped in order to look
  const OdometryNoise& odometry;  ///< how the covariance grows until then
};

/// What a policy has chosen.
struct LookChoice {
  LandmarkId landmark = 0;
  std::optional<double> zoom_mm = {};      ///< planned; nothing: by the landmark's size
  std::optional<double> suitability = {};  ///< in [0, 1], when the policy has such a measure
  std::string reason = {};                 ///< for the event log, a few words
};

/// Chooses which landmark to look at next.
class LookPolicy {
 public:
  virtual ~LookPolicy() = default;
  virtual std::string_view name() const = 0;
  /// The landmark to look at from where the robot believes to be, or nothing when none will do.
  virtual std::optional<LookChoice> choose(const LookContext& context) = 0;
  /// The robot follows this path from now on; called before the first choice.
  virtual void follow(const Path& /*path*/) {}
  /// Whether head and zoom wait, between two looks, where the policy would look now.
  virtual bool prepares() const { return false; }
};

/// What the policies are made from.
struct LookPolicyParts {
  std::optional<LandmarkId> fixed;  ///< the landmark of the policy "fixed"
  RandomStream stream;              ///< of the policy "random"
  // The rest is of the policy "fuzzy"; the references outlive it.
  const LandmarkMap& landmarks;
  const Visibility& visibility;
  HeadModel head = {};
  FuzzyRules rules = {};
  PerceptionParams perception = {};
};

struct LookPolicyEntry : NameEntry {
  std::unique_ptr<LookPolicy> (*make)(const LookPolicyParts& parts);
};

/// Every policy.
const std::vector<LookPolicyEntry>& look_policies();

/// The policy of that name; null for a name that the table has not.
std::unique_ptr<LookPolicy> make_look_policy(const std::string& name, const LookPolicyParts& parts);

/// Whether a landmark is visible from @p pose and not excluded.
bool can_be_observed(const Landmark& landmark, const LookContext& context, const Pose2& pose);

}  // namespace vigia::planner
