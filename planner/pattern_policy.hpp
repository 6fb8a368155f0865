#pragma once

#include "vigia/core/angle.hpp"
#include "vigia/planner/look_policy.hpp"

namespace vigia::planner {

/// QUIXOTE's choice (Adán §4): of the patterns (and tags) that are not hidden by a wall and did not
/// fail lately, not too far (Visibility), and seen at φ ≥ min_view_angle between normal and line of
/// sight, the one that appears largest, which is the nearest. Discs have no φ that they would need:
/// they are left out. Nothing when none will do.
class PatternPolicy final : public LookPolicy {
 public:
  explicit PatternPolicy(double min_view_angle = from_deg(25.0))
      : min_view_angle_(min_view_angle) {}

  std::string_view name() const override { return "pattern"; }
  std::optional<LookChoice> choose(const LookContext& context) override;

 private:
  double min_view_angle_;
};

}  // namespace vigia::planner
