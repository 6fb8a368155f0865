#include "read_params.hpp"

#include "vigia/planner/look_policy.hpp"

namespace vigia::mission {

namespace {

/// Matched to the robot's ring unless the mission says otherwise.
void read_pilot_ring(MapReader reader, const sim::RangeRingParams& ring,
                     pilot::RingParams& params) {
  params.half_angle_deg = 0.5 * to_deg(ring.cone);
  params.sigma_m = reader.number("sigma_m", {0.0, 1.0}, ring.sigma_m);
  params.sigma_relative = reader.number("sigma_relative", {0.0, 1.0}, ring.sigma_relative);
  params.horizon_m = reader.number("horizon_m", {0.1, 100.0}, params.horizon_m);
  params.confirmations =
      static_cast<int>(reader.integer("confirmations", {1, 100}, params.confirmations));
  params.memory_s = reader.number("memory_s", {0.0, 60.0}, params.memory_s);
  params.thing_radius_m = reader.number("thing_radius_m", {0.0, 2.0}, params.thing_radius_m);
  reader.finish();
}

void read_avoidance(MapReader reader, pilot::AvoidanceParams& params) {
  params.near_m = reader.number("near_m", {0.0, 10.0}, params.near_m);
  params.notice_m = reader.number("notice_m", {params.near_m + 0.1, 20.0}, params.notice_m);
  params.corridor_m = reader.number("corridor_m", {0.0, 2.0}, params.corridor_m);
  params.beside_m = reader.number("beside_m", {0.0, 2.0}, params.beside_m);
  params.wall_m = reader.number("wall_m", {0.0, 2.0}, params.wall_m);
  params.lane_m = reader.number("lane_m", {0.05, 1.0}, params.lane_m);
  params.widest_m = reader.number("widest_m", {params.lane_m, 5.0}, params.widest_m);
  params.horizon_m = reader.number("horizon_m", {0.5, 10.0}, params.horizon_m);
  params.speed = reader.number("speed_mps", {0.01, 5.0}, params.speed);
  params.patience_s = reader.number("patience_s", {0.1, 60.0}, params.patience_s);
  params.brake_m = reader.number("brake_m", {0.0, 2.0}, params.brake_m);
  params.brake_known_m = reader.number("brake_known_m", {0.0, 2.0}, params.brake_known_m);
  params.rejoin_m = reader.number("rejoin_m", {0.01, 1.0}, params.rejoin_m);
  params.blocked_s = reader.number("blocked_s", {0.5, 600.0}, params.blocked_s);
  params.give_up_s = reader.number("give_up_s", {params.blocked_s, 1e5}, params.give_up_s);
  reader.finish();
}

}  // namespace

void read_ekf(MapReader reader, const sim::RobotParams& robot, localization::EkfParams& params) {
  // Matched to the robot unless the mission says otherwise.
  params.odometry = robot.odometry;
  params.sensor = robot.sensor;
  MapReader odometry = reader.map("odometry");
  params.odometry.trans_per_sqrt_m =
      odometry.number("trans_per_sqrt_m", {0.0, 1.0}, params.odometry.trans_per_sqrt_m);
  params.odometry.rot_per_sqrt_m = from_deg(
      odometry.number("rot_per_sqrt_m_deg", {0.0, 60.0}, to_deg(params.odometry.rot_per_sqrt_m)));
  params.odometry.rot_per_sqrt_rad = from_deg(odometry.number(
      "rot_per_sqrt_rad_deg", {0.0, 60.0}, to_deg(params.odometry.rot_per_sqrt_rad)));
  odometry.finish();
  MapReader sensor = reader.map("sensor");
  params.sensor.look_angle =
      from_deg(sensor.number("look_angle_deg", {0.0, 10.0}, to_deg(params.sensor.look_angle)));
  params.sensor.reading_angle = from_deg(
      sensor.number("reading_angle_deg", {0.0, 10.0}, to_deg(params.sensor.reading_angle)));
  params.sensor.look_focal = sensor.number("look_focal", {0.0, 0.5}, params.sensor.look_focal);
  sensor.finish();
  params.gate_probability =
      reader.number("gate_probability", {0.5, 0.999999}, params.gate_probability);
  params.ambiguity_ratio = reader.number("ambiguity_ratio", {1.0, 1e9}, params.ambiguity_ratio);
  params.centre_floor_px = reader.number("centre_floor_px", {0.0, 10.0}, params.centre_floor_px);
  params.size_floor = reader.number("size_floor", {0.0, 1.0}, params.size_floor);
  params.use_size = reader.boolean("use_size", params.use_size);
  params.iterations = static_cast<int>(reader.integer("iterations", {1, 20}, params.iterations));
  params.look_images =
      static_cast<int>(reader.integer("look_images", {1, 10000}, params.look_images));
  params.converged = reader.number("converged", {1e-12, 1.0}, params.converged);
  params.history_s = reader.number("history_s", {0.0, 60.0}, params.history_s);
  params.lost_sigma_m = reader.number("lost_sigma_m", {0.01, 100.0}, params.lost_sigma_m);
  params.lost_rejections =
      static_cast<int>(reader.integer("lost_rejections", {1, 100000}, params.lost_rejections));
  params.lost_looks = static_cast<int>(reader.integer("lost_looks", {1, 1000}, params.lost_looks));
  params.nis_looks = static_cast<int>(reader.integer("nis_looks", {1, 1000}, params.nis_looks));
  params.nis_probability = reader.number("nis_probability", {1e-12, 0.5}, params.nis_probability);
  reader.finish();
}

void read_look(MapReader& reader, LookParams& params) {
  const auto policies = planner::look_policy_names();
  std::size_t usual = 0;
  while (usual + 1 < policies.size() && policies[usual] != params.policy) ++usual;
  params.policy = policies[reader.choice("policy", policies, usual)];
  if (reader.has("fixed_landmark"))
    params.fixed_landmark = static_cast<LandmarkId>(reader.integer("fixed_landmark", {0, 1000000}));
  MapReader trigger = reader.map("trigger");
  params.trigger.kind = trigger.choice("kind", {"distance", "uncertainty"}, 0) == 0
                            ? planner::LookTriggerParams::Kind::distance
                            : planner::LookTriggerParams::Kind::uncertainty;
  params.trigger.distance_m =
      trigger.number("distance_m", {0.0, 1000.0}, params.trigger.distance_m);
  params.trigger.limit_1_m = trigger.number("limit_1_m", {0.0, 100.0}, params.trigger.limit_1_m);
  params.trigger.limit_2_m =
      trigger.number("limit_2_m", {params.trigger.limit_1_m, 100.0}, params.trigger.limit_2_m);
  params.trigger.goal_m = trigger.number("goal_m", {0.0, 1000.0}, params.trigger.goal_m);
  params.trigger.goal_limit_m =
      trigger.number("goal_limit_m", {0.0, 100.0}, params.trigger.goal_limit_m);
  trigger.finish();
  read_perception(reader, params);
  MapReader visibility = reader.map("visibility");
  params.visibility.max_view_angle_deg =
      visibility.number("max_view_angle_deg", {1.0, 85.0}, params.visibility.max_view_angle_deg);
  params.visibility.min_range_m =
      visibility.number("min_range_m", {0.0, 100.0}, params.visibility.min_range_m);
  params.visibility.max_range_m = visibility.number(
      "max_range_m", {params.visibility.min_range_m, 1000.0}, params.visibility.max_range_m);
  visibility.finish();
  params.period_s = reader.number("period_s", {0.0, 10.0}, params.period_s);
  params.dwell_s = reader.number("dwell_s", {0.0, 60.0}, params.dwell_s);
  params.timeout_s = reader.number("timeout_s", {0.1, 600.0}, params.timeout_s);
  params.radius_px = reader.number("radius_px", {4.0, 200.0}, params.radius_px);
  params.fill = reader.number("fill", {0.05, 0.95}, params.fill);
  params.exclude_s = reader.number("exclude_s", {0.0, 600.0}, params.exclude_s);
  params.rejections_to_drop =
      static_cast<int>(reader.integer("rejections_to_drop", {1, 1000}, params.rejections_to_drop));
  params.failures_to_lose =
      static_cast<int>(reader.integer("failures_to_lose", {1, 1000}, params.failures_to_lose));
  reader.finish();
}

void read_gaze(MapReader reader, servo::GazeParams& params) {
  MapReader servo = reader.map("servo");
  params.servo.gain = servo.number("gain", {0.0, 50.0}, params.servo.gain);
  params.servo.feed_forward = servo.boolean("feed_forward", params.servo.feed_forward);
  servo.finish();
  MapReader zoom = reader.map("zoom");
  params.zoom.gain = zoom.number("gain", {0.0, 50.0}, params.zoom.gain);
  params.zoom.dead_band = zoom.number("dead_band", {0.0, 2.0}, params.zoom.dead_band);
  zoom.finish();
  params.settle_deg = reader.number("settle_deg", {0.01, 30.0}, params.settle_deg);
  params.settle_focal = reader.number("settle_focal", {0.001, 1.0}, params.settle_focal);
  params.lost_grace_s = reader.number("lost_grace_s", {0.0, 10.0}, params.lost_grace_s);
  params.acquire_s = reader.number("acquire_s", {0.0, 60.0}, params.acquire_s);
  params.search_s = reader.number("search_s", {0.0, 60.0}, params.search_s);
  params.search_step_deg = reader.number("search_step_deg", {0.1, 60.0}, params.search_step_deg);
  params.search_radius_px =
      reader.number("search_radius_px", {2.0, 200.0}, params.search_radius_px);
  params.motion_horizon_s = reader.number("motion_horizon_s", {0.0, 60.0}, params.motion_horizon_s);
  params.look_angle_deg = reader.number("look_angle_deg", {0.0, 10.0}, params.look_angle_deg);
  params.aim_gain = reader.number("aim_gain", {0.1, 50.0}, params.aim_gain);
  reader.finish();
}

void read_pilot(MapReader reader, const sim::RobotSetup& robot, pilot::PilotParams& params) {
  pilot::PathFollowerParams& follower = params.follower;
  follower.lookahead_m = reader.number("lookahead_m", {0.02, 5.0}, follower.lookahead_m);
  follower.turn_in_place_deg =
      reader.number("turn_in_place_deg", {1.0, 180.0}, follower.turn_in_place_deg);
  follower.goal_tolerance_m =
      reader.number("goal_tolerance_m", {0.005, 5.0}, follower.goal_tolerance_m);
  follower.slow_down_m = reader.number("slow_down_m", {0.0, 10.0}, follower.slow_down_m);
  if (robot.range_ring) read_pilot_ring(reader.map("ring"), *robot.range_ring, params.ring);
  read_avoidance(reader.map("avoidance"), params.avoidance);
  reader.finish();
}

void read_recovery(MapReader reader, RecoveryParams& params) {
  params.step_fraction = reader.number("step_fraction", {0.1, 1.0}, params.step_fraction);
  params.tilt = from_deg(reader.number("tilt_deg", {-89.0, 89.0}, to_deg(params.tilt)));
  params.settle_s = reader.number("settle_s", {0.0, 5.0}, params.settle_s);
  params.explained_share = reader.number("explained_share", {0.0, 1.0}, params.explained_share);
  params.sweeps = static_cast<int>(reader.integer("sweeps", {1, 100}, params.sweeps));
  reader.finish();
}

}  // namespace vigia::mission
