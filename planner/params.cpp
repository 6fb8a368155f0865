#include "vigia/planner/params.hpp"

namespace vigia::planner {

void describe(ParamVisitor& v, LookTriggerParams& p) {
  v.choice("kind", p.kind, {"distance", "uncertainty"}, "what demands a look");
  v.number("distance_m", p.distance_m, {0.0, 1000.0},
           "driven from one look's first image to the next order");
  v.number("limit_1_m", p.limit_1_m, {0.0, 100.0},
           "√λ_max of the position covariance above which the robot looks in motion");
  v.number("limit_2_m", p.limit_2_m, {bound_of("limit_1_m", p.limit_1_m), 100.0},
           "√λ_max of the position covariance above which it stops first");
  v.number("goal_m", p.goal_m, {0.0, 1000.0},
           "of the path's end, on which `goal_limit_m` takes the place of `limit_1_m`");
  v.number("goal_limit_m", p.goal_limit_m, {0.0, 100.0}, "√λ_max for a look near the goal");
}

void describe(ParamVisitor& v, VisibilityParams& p) {
  v.number("max_view_angle_deg", p.max_view_angle_deg, {1.0, 85.0},
           "between a visible landmark's normal and the line of sight");
  v.number("min_range_m", p.min_range_m, {0.0, 100.0}, "of a visible landmark");
  v.number("max_range_m", p.max_range_m, {bound_of("min_range_m", p.min_range_m), 1000.0},
           "of a visible landmark");
}

void describe(ParamVisitor& v, PathModelParams& p) {
  v.number("turn_deg", p.turn_deg, {1.0, 180.0},
           "a sudden change of heading above this is a turn point");
  v.number("spacing_m", p.spacing_m, {0.1, 100.0}, "of the control positions");
  v.number("radius_m", p.radius_m, {0.05, 50.0}, "of a control position's disc");
  v.number("area_m", p.area_m, {0.1, 1000.0}, "length of a control area");
  v.number("distance_ratio", p.distance_ratio, {1.0, 1000.0},
           "farthest over nearest distance to a landmark within one control area");
}

void describe(ParamVisitor& v, FuzzyRules& rules) {
  v.text_or_file("suitability", rules.suitability.text, rules.suitability.name,
                 "rules for the suitability of a disc (`.fll`)");
  v.text_or_file("points", rules.points.text, rules.points.name,
                 "rules for the suitability of a pattern or tag (`.fll`)");
  v.text_or_file("zoom_groups", rules.zoom_groups.text, rules.zoom_groups.name,
                 "groups of distances that share a zoom (`.fll`)");
  v.text_or_file("choice", rules.choice.text, rules.choice.name,
                 "rules for the choice by the covariance's axes (`.fll`)");
}

void describe(ParamVisitor& v, PerceptionParams& p) {
  v.number("reject", p.reject, {0.0, 1.0}, "suitability below which the plan rejects a landmark");
  v.number("min_value", p.min_value, {0.0, 1.0},
           "share of the best visible landmark's value from which on the best preselected one is "
           "taken");
  v.number("both_uncertain_m", p.both_uncertain_m, {0.0, 100.0},
           "standing, landmarks along both axes come in turn while the σ of both exceed this");
  v.number("zoom_cost_per_s", p.zoom_cost_per_s, {0.0, 100.0},
           "suitability that a second of the zoom's travel outweighs");
  v.number("min_radius_px", p.min_radius_px, {1.0, 1000.0},
           "of a disc's image that needs no optics move");
  v.number("max_radius_px", p.max_radius_px, {bound_of("min_radius_px", p.min_radius_px), 1000.0},
           "of a disc's image that needs no optics move");
  v.number("min_feature_px", p.min_feature_px, {1.0, 100.0},
           "width of a pattern's dot or a tag's field that needs no optics move; the other side "
           "is `fill`");
}

void describe(ParamVisitor& v, RouteParams& p) {
  v.number("clearance_m", p.clearance_m, {0.0, 5.0},
           "beyond the robot's radius, where the building allows");
  v.integer("iterations", p.iterations, {1, 1000000}, "states that the planner samples per leg");
  v.number("spacing_m", p.spacing_m, {0.005, 1.0}, "of the resampled path");
}

}  // namespace vigia::planner
