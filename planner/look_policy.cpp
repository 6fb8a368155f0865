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
    if (can_be_watched(landmark, context, context.belief.pose)) result.push_back(&landmark);
  }
  return result;
}

class FixedPolicy final : public LookPolicy {
 public:
  explicit FixedPolicy(std::optional<LandmarkId> fixed) : fixed_(fixed) {}
  std::string_view name() const override { return "fixed"; }
  std::optional<LookChoice> choose(const LookContext& context) override {
    const Landmark* landmark = fixed_ ? context.landmarks.find(*fixed_) : nullptr;
    if (landmark == nullptr || !can_be_watched(*landmark, context, context.belief.pose))
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

}  // namespace

bool can_be_watched(const Landmark& landmark, const LookContext& context, const Pose2& pose) {
  const auto& excluded = context.excluded;
  return std::find(excluded.begin(), excluded.end(), landmark.id) == excluded.end() &&
         context.visibility.sight(landmark, pose) == Sight::visible;
}

std::unique_ptr<LookPolicy> make_look_policy(const std::string& name,
                                             const LookPolicyParts& parts) {
  if (name == "fixed") return std::make_unique<FixedPolicy>(parts.fixed);
  if (name == "random") return std::make_unique<RandomPolicy>(parts.stream);
  if (name == "nearest") return std::make_unique<NearestPolicy>();
  if (name == "greedy") return make_greedy_policy();
  if (name == "fuzzy") return make_fuzzy_policy(parts);
  if (name == "pattern") return std::make_unique<PatternPolicy>();
  return nullptr;
}

std::vector<std::string> look_policy_names() {
  return {"fixed", "random", "nearest", "greedy", "fuzzy", "pattern"};
}

}  // namespace vigia::planner
