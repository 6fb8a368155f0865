#include "params.hpp"

#include "vigia/planner/look_policy.hpp"
#include "vigia/planner/params.hpp"

namespace vigia::mission {
namespace {

void describe_fuzzy(ParamVisitor& v, LookParams& p) {
  describe(v, p.rules);
  describe(v, p.perception);
  // A rule base that is wrong is reported when the mission is read, not when it is driven.
  if (v.reader() != nullptr) {
    const planner::FuzzySupervisors readable(p.rules);
  }
}

void describe_look(ParamVisitor& v, LookParams& p) {
  v.number("period_s", p.period_s, {0.0, 10.0}, "how often the planner is asked");
  v.number("dwell_s", p.dwell_s, {0.0, 60.0}, "how long a landmark is observed once tracked");
  v.number(
      "timeout_s", p.timeout_s, {0.1, 600.0},
      "an order without a feature by then has expired; a slow head or zoom has what it needs from "
      "end to end, and 2 s, if that is longer");
  v.number("radius_px", p.radius_px, {4.0, 200.0}, "apparent radius of a disc that the zoom holds");
  v.number("fill", p.fill, {0.05, 0.95},
           "share of half the image's height that the zoom fills with a pattern or tag");
  v.number("exclude_s", p.exclude_s, {0.0, 600.0},
           "how long a landmark that failed is left out; doubles with each failure until it is "
           "seen again");
  v.integer("rejections_to_drop", p.rejections_to_drop, {1, 1000},
            "frames in a row that the filter rejects, after which the look is given up");
  v.integer(
      "failures_to_lose", p.failures_to_lose, {1, 1000},
      "looks in a row, at two landmarks at least, that showed nothing, after which the belief "
      "is lost (at one landmark alone: twice as many; two landmarks suffice where there is no "
      "third to look at)");
}

}  // namespace

void describe(ParamVisitor& v, LookParams& p) {
  v.name("policy", p.policy, names_of(planner::look_policies()),
         "which landmark to look at; `vigia help policies` tells them apart");
  v.given("fixed_landmark", [&] {
    LandmarkId fixed = p.fixed_landmark.value_or(0);
    v.integer("fixed_landmark", fixed, {0, 1000000}, About("of the policy `fixed`").required());
    p.fixed_landmark = fixed;
  });
  v.map("trigger", p.trigger, "when a look is demanded");
  v.map("areas", p.perception.path, "how the fuzzy planner divides the path");
  v.map("fuzzy", "of the policy `fuzzy`", [&] { describe_fuzzy(v, p); });
  v.map("visibility", p.visibility, "which landmarks count as visible");
  describe_look(v, p);
}

void describe(ParamVisitor& v, RecoveryParams& p) {
  v.number("step_fraction", p.step_fraction, {0.1, 1.0},
           "of the horizontal field of view between two stops of the sweep");
  v.angle("tilt_deg", p.tilt, {-89.0, 89.0}, "of the head during the sweep");
  v.number("settle_s", p.settle_s, {0.0, 5.0}, "standing still before a picture counts");
  v.number("explained_share", p.explained_share, {0.0, 1.0},
           "of the discs that a sweep shows, which the pose must explain to be believed");
  v.integer("sweeps", p.sweeps, {1, 100},
            "without a result, after which the outcome is `lost`; between two of them the robot "
            "goes some steps to where its range ring has most room");
  v.number("ring_probability", p.ring_probability, {0.5, 1.0},
           "of being elsewhere, by beams of the range ring that see through walls of the map, at "
           "which the belief is lost; 1: never");
  v.number("contact_risk", p.contact_risk, {0.0, 0.5},
           "of a robot without a head that may be at several places: the weight of those from "
           "which it would drive into the building; above, it leaves its path until it knows");
  v.number("wander_s", p.wander_s, {1.0, 100000.0},
           "without knowing where it is, after which such a robot's outcome is `lost`");
}

}  // namespace vigia::mission
