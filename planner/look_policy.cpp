#include "vigia/planner/look_policy.hpp"

#include "fuzzy_policy.hpp"
#include "greedy_policy.hpp"
#include "pattern_policy.hpp"

#include <algorithm>

namespace vigia::planner {
namespace {

std::vector<const Landmark*> candidates(const LookContext& context) {
  std::vector<const Landmark*> result;
  for (const Landmark& landmark : context.landmarks.all()) {
    if (can_be_observed(landmark, context, context.belief.pose)) result.push_back(&landmark);
  }
  return result;
}

class FixedPolicy final : public LookPolicy {
 public:
  explicit FixedPolicy(std::optional<LandmarkId> fixed) : fixed_(fixed) {}
  std::string_view name() const override { return "fixed"; }
  std::optional<LookChoice> choose(const LookContext& context) override {
    const Landmark* landmark = fixed_ ? context.landmarks.find(*fixed_) : nullptr;
    if (landmark == nullptr || !can_be_observed(*landmark, context, context.belief.pose))
      return std::nullopt;
    return LookChoice{*fixed_, {}, {}, "the fixed landmark"};
  }

 private:
  std::optional<LandmarkId> fixed_;
};

class RandomPolicy final : public LookPolicy {
 public:
  explicit RandomPolicy(RandomStream stream) : stream_(stream) {}
  std::string_view name() const override { return "random"; }
  std::optional<LookChoice> choose(const LookContext& context) override {
    const auto landmarks = candidates(context);
    if (landmarks.empty()) return std::nullopt;
    return LookChoice{landmarks[stream_.index(landmarks.size())]->id, {}, {}, "drawn"};
  }

 private:
  RandomStream stream_;
};

class NearestPolicy final : public LookPolicy {
 public:
  std::string_view name() const override { return "nearest"; }
  std::optional<LookChoice> choose(const LookContext& context) override {
    const auto landmarks = candidates(context);
    if (landmarks.empty()) return std::nullopt;
    const Pose2& pose = context.belief.pose;
    const auto nearest = std::min_element(
        landmarks.begin(), landmarks.end(), [&](const Landmark* a, const Landmark* b) {
          return context.visibility.range(*a, pose) < context.visibility.range(*b, pose);
        });
    return LookChoice{(*nearest)->id, {}, {}, "the nearest"};
  }
};

std::unique_ptr<LookPolicy> make_fixed(const LookPolicyParts& parts) {
  return std::make_unique<FixedPolicy>(parts.fixed);
}

std::unique_ptr<LookPolicy> make_random(const LookPolicyParts& parts) {
  return std::make_unique<RandomPolicy>(parts.stream);
}

std::unique_ptr<LookPolicy> make_nearest(const LookPolicyParts&) {
  return std::make_unique<NearestPolicy>();
}

std::unique_ptr<LookPolicy> make_greedy(const LookPolicyParts&) {
  return make_greedy_policy();
}

std::unique_ptr<LookPolicy> make_pattern(const LookPolicyParts&) {
  return std::make_unique<PatternPolicy>();
}

}  // namespace

bool can_be_observed(const Landmark& landmark, const LookContext& context, const Pose2& pose) {
  const auto& excluded = context.excluded;
  return std::find(excluded.begin(), excluded.end(), landmark.id) == excluded.end() &&
         context.visibility.sight(landmark, pose) == Sight::visible;
}

const std::vector<LookPolicyEntry>& look_policies() {
  static const std::vector<LookPolicyEntry> table{
      {{"fixed", "always the same landmark", "the key planner.fixed_landmark"}, &make_fixed},
      {{"random", "a visible landmark by lot", "landmarks"}, &make_random},
      {{"nearest", "the nearest visible landmark", "landmarks"}, &make_nearest},
      {{"greedy", "the least expected trace of the position's covariance after the look",
        "landmarks"},
       &make_greedy},
      {{"fuzzy", "the perception plan of Armingol et al.", "landmarks"}, &make_fuzzy_policy},
      {{"pattern", "the nearest pattern or tag seen at φ ≥ 25° (QUIXOTE)", "patterns or tags"},
       &make_pattern},
  };
  return table;
}

std::unique_ptr<LookPolicy> make_look_policy(const std::string& name,
                                             const LookPolicyParts& parts) {
  const LookPolicyEntry* entry = find_name(look_policies(), name);
  return entry != nullptr ? entry->make(parts) : nullptr;
}

}  // namespace vigia::planner
