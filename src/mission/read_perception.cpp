#include "read_params.hpp"

namespace vigia::mission {
namespace {

void read_rules(MapReader& fuzzy, const std::string& key, planner::FuzzyText& rules) {
  if (auto given = fuzzy.text_or_file(key)) rules = {given->text, given->name};
}

}  // namespace

void read_perception(MapReader& look, LookParams& params) {
  MapReader areas = look.map("areas");
  planner::PathModelParams& path = params.perception.path;
  path.turn_deg = areas.number("turn_deg", {1.0, 180.0}, path.turn_deg);
  path.spacing_m = areas.number("spacing_m", {0.1, 100.0}, path.spacing_m);
  path.radius_m = areas.number("radius_m", {0.05, 50.0}, path.radius_m);
  path.area_m = areas.number("area_m", {0.1, 1000.0}, path.area_m);
  path.distance_ratio = areas.number("distance_ratio", {1.0, 1000.0}, path.distance_ratio);
  areas.finish();
  MapReader fuzzy = look.map("fuzzy");
  read_rules(fuzzy, "suitability", params.rules.suitability);
  read_rules(fuzzy, "points", params.rules.points);
  read_rules(fuzzy, "zoom_groups", params.rules.zoom_groups);
  read_rules(fuzzy, "choice", params.rules.choice);
  planner::PerceptionParams& plan = params.perception;
  plan.reject = fuzzy.number("reject", {0.0, 1.0}, plan.reject);
  plan.min_value = fuzzy.number("min_value", {0.0, 1.0}, plan.min_value);
  plan.both_uncertain_m = fuzzy.number("both_uncertain_m", {0.0, 100.0}, plan.both_uncertain_m);
  plan.zoom_cost_per_s = fuzzy.number("zoom_cost_per_s", {0.0, 100.0}, plan.zoom_cost_per_s);
  plan.min_radius_px = fuzzy.number("min_radius_px", {1.0, 1000.0}, plan.min_radius_px);
  plan.max_radius_px =
      fuzzy.number("max_radius_px", {plan.min_radius_px, 1000.0}, plan.max_radius_px);
  plan.min_feature_px = fuzzy.number("min_feature_px", {1.0, 100.0}, plan.min_feature_px);
  fuzzy.finish();
  // A rule base that is wrong is reported when the mission is read, not when it is driven.
  const planner::FuzzySupervisors readable(params.rules);
}

}  // namespace vigia::mission
