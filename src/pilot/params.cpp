#include "vigia/pilot/params.hpp"

namespace vigia::pilot {

void describe(ParamVisitor& v, PathFollowerParams& p) {
  v.number("lookahead_m", p.lookahead_m, {0.02, 5.0}, "of the pure pursuit");
  v.number("turn_in_place_deg", p.turn_in_place_deg, {1.0, 180.0},
           "heading error above which the base turns on the spot");
  v.number("goal_tolerance_m", p.goal_tolerance_m, {0.005, 5.0},
           "from the path's end, where the estimate has arrived");
  v.number("slow_down_m", p.slow_down_m, {0.0, 10.0},
           "before the path's end, over which the speed falls");
}

void describe(ParamVisitor& v, RingParams& p) {
  v.number("sigma_m", p.sigma_m, {0.0, 1.0},
           About("σ of a reading that the pilot assumes").otherwise("the robot's"));
  v.number("sigma_relative", p.sigma_relative, {0.0, 1.0},
           About("its part that grows with the range").otherwise("the robot's"));
  v.number("horizon_m", p.horizon_m, {0.1, 100.0}, "farther echoes are left alone");
  v.integer("confirmations", p.confirmations, {1, 100}, "scans that must show a thing");
  v.number("memory_s", p.memory_s, {0.0, 60.0},
           "how long a thing counts that nothing shows any more");
  v.number("thing_radius_m", p.thing_radius_m, {0.0, 2.0},
           "an echo is taken for the near side of something of this radius");
}

void describe(ParamVisitor& v, AvoidanceParams& p) {
  v.number("near_m", p.near_m, {0.0, 10.0},
           "along the path to an obstacle, where it has all the attention");
  v.number("notice_m", p.notice_m, {bound_of("near_m", p.near_m, 0.1), 20.0},
           "along the path to an obstacle, where it begins to matter");
  v.number("corridor_m", p.corridor_m, {0.0, 2.0},
           "beside the robot, free of things for the path to count as free");
  v.number("beside_m", p.beside_m, {0.0, 2.0}, "kept from things off the path");
  v.number("wall_m", p.wall_m, {0.0, 2.0}, "kept from known walls off the path");
  v.number("lane_m", p.lane_m, {0.05, 1.0}, "spacing of the lanes beside the path");
  v.number("widest_m", p.widest_m, {bound_of("lane_m", p.lane_m), 5.0}, "to the outermost lane");
  v.number("horizon_m", p.horizon_m, {0.5, 10.0}, "length of the lanes");
  v.number("speed_mps", p.speed, {0.01, 5.0}, "off the path");
  v.number("patience_s", p.patience_s, {0.1, 60.0},
           "waited for somebody to pass, before they are driven round");
  v.number("brake_m", p.brake_m, {0.0, 2.0},
           "left before an unknown thing when the robot has stopped");
  v.number("brake_known_m", p.brake_known_m, {0.0, 2.0},
           "left before a known wall when the robot has stopped");
  v.number("rejoin_m", p.rejoin_m, {0.01, 1.0}, "from the path, where it is followed again");
  v.number("blocked_s", p.blocked_s, {0.5, 600.0},
           "without progress, after which the path is blocked and another is planned; again after "
           "as long");
  v.number("give_up_s", p.give_up_s, {bound_of("blocked_s", p.blocked_s), 1e5},
           "without progress, after which the outcome is `stuck`");
}

}  // namespace vigia::pilot
