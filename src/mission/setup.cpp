#include "vigia/mission/setup.hpp"

#include "params.hpp"
#include "robot_parts.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "vigia/core/key_reference.hpp"
#include "vigia/core/noise_params.hpp"
#include "vigia/localization/flow_fed_localizer.hpp"
#include "vigia/localization/params.hpp"
#include "vigia/mission/delays.hpp"
#include "vigia/mission/localizers.hpp"
#include "vigia/pilot/params.hpp"
#include "vigia/planner/params.hpp"
#include "vigia/planner/tight_place.hpp"
#include "vigia/servo/params.hpp"
#include "vigia/sim/params.hpp"
#include "vigia/tracking/trackers.hpp"

namespace vigia::mission {
namespace {

constexpr const char* kNobody = "none";
constexpr double kLeastRise_m = 0.1;  // of a ceiling above the camera

const Bounds kMetres{-1e4, 1e4};
constexpr double kLeastRoute_m = 0.01;
/// What the pilot's executor keeps free beside the robot.
constexpr double kBeside_m = 0.025;

void describe_world(ParamVisitor& v, MissionSetup& setup) {
  describe(v, setup.world);
  auto appearance = std::make_shared<sim::Appearance>();
  sim::describe_appearance(v, setup.world, *appearance);
  setup.appearance = std::move(appearance);
}

void describe_start(ParamVisitor& v, MissionSetup& setup) {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double heading = 0.0;
  v.vector("position_m", position, kMetres,
           About("where the localizers are told the robot is").required());
  v.angle("heading_deg", heading, {-360.0, 360.0}, About("which heading they are told").required());
  v.number("sigma_m", setup.start_sigma_m, {0.0, 5.0},
           "the true position is drawn round it with this, each coordinate; the prior says so");
  v.angle("sigma_deg", setup.start_sigma_rad, {0.0, 180.0},
          "the true heading is drawn round it with this; the prior says so");
  setup.start = {position.x(), position.y(), wrap_angle(heading)};
  bool told = true;
  v.boolean(
      "prior", told,
      "whether the localizers are told where the drive begins; `false`: they find themselves");
  if (told) {
    const double variance = setup.start_sigma_m * setup.start_sigma_m;
    const Eigen::Vector3d variances(variance, variance,
                                    setup.start_sigma_rad * setup.start_sigma_rad);
    setup.prior = Prior{setup.start, variances.asDiagonal()};
  }
  if (v.reader() == nullptr) return;
  const double radius_m = setup.robot.robot.radius_m;
  v.require(setup.world.plan.clearance(position) >= radius_m, "position_m",
            "the robot (radius " + std::to_string(radius_m) +
                " m) does not fit here: it would overlap a wall or an obstacle, or stand outside "
                "the room");
}

[[noreturn]] void report_route_failure(const MapReader& route, const planner::Route& found) {
  const std::string leg = "leg " + std::to_string(found.leg + 1) + " of the route";
  switch (found.status) {
    case planner::RouteStatus::start_blocked:
      throw route.error("via_m", leg + " begins where the robot does not fit");
    case planner::RouteStatus::goal_blocked:
      throw route.error(found.leg + 2 == found.waypoints.size() ? "goal_m" : "via_m",
                        leg + " ends where the robot does not fit");
    default:
      throw route.error("goal_m", "no route: " + leg +
                                      " has no passage wide enough for the robot; check walls, "
                                      "obstacles and clearance_m");
  }
}

void describe_route(ParamVisitor& v, MissionSetup& setup) {
  setup.waypoints.push_back(setup.start.position());
  v.given("via_m", [&] {
    std::vector<Eigen::Vector2d> vias;
    v.points("via_m", vias, kMetres, 0, About("to pass, in order").required());
    setup.waypoints.insert(setup.waypoints.end(), vias.begin(), vias.end());
  });
  Eigen::Vector2d goal = Eigen::Vector2d::Zero();
  v.vector("goal_m", goal, kMetres, About("where to go").required());
  setup.waypoints.push_back(goal);
  const bool moves = std::any_of(
      setup.waypoints.begin(), setup.waypoints.end(),
      [&](const auto& p) { return (p - setup.waypoints.front()).norm() > kLeastRoute_m; });
  v.require(moves, "goal_m", "the route ends where it starts: nothing to drive");
  describe(v, setup.route);
  v.integer("seed", setup.route_seed, {0, 2147483647},
            "of the route planner: one route for every seed of the mission");
}

/// A robot may start and end where it touches a wall all but. On the way the pilot would not pass.
void require_room_on_the_way(const MapReader& route, const MissionSetup& setup, const Path& path) {
  const double radius = setup.route.robot_radius_m;
  const auto tightest = planner::tightest_place(setup.world.plan, path, radius, 2.0 * radius);
  if (tightest.beside_m < kBeside_m)
    throw route.error("goal_m",
                      fmt::format("too narrow for the robot: {:.3f} m beside it at [{:.2f}, "
                                  "{:.2f}], and the pilot keeps {:g} m from what it sees",
                                  tightest.beside_m, tightest.at.x(), tightest.at.y(), kBeside_m));
}

/// @p route: its map in the file.
void plan_mission_route(const MapReader& route, MissionSetup& setup) {
  setup.route.robot_radius_m = setup.robot.robot.radius_m;
  const planner::Route found =
      planner::plan_route(setup.world.plan, setup.waypoints, setup.route, setup.route_seed);
  if (found.status != planner::RouteStatus::found) report_route_failure(route, found);
  require_room_on_the_way(route, setup, found.path);
  setup.path = found.path;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const char* remedy_without_prior(FirstPose first_pose) {
  switch (first_pose) {
    case FirstPose::prior:
      return "it never finds itself, give one or leave it out of the localizers";
    case FirstPose::recovery:
      return "give one, leave it out of the localizers, or let it be the primary of a robot whose "
             "head can look around";
    case FirstPose::looks:
      return "give one, leave it out of the localizers, or let a head direct the robot's camera";
    case FirstPose::itself:
      break;
  }
  return "give one";
}

void require_fit(ParamVisitor& v, const char* key, const MissionSetup& setup) {
  if (v.reader() == nullptr) return;
  for (const std::string& name : setup.localizers) {
    const LocalizerEntry& entry = *find_name(localizers(), name);
    v.require(entry.fits(setup), key, "'" + name + "' needs " + entry.needs);
    v.require(setup.prior || !needs_prior(entry, setup), key,
              fmt::format("'{}' cannot start without a prior (start.prior: false): {}", name,
                          remedy_without_prior(entry.first_pose)));
  }
}

/// The localizers that are named, one of which closes the loop; or that one, and the usual ones.
void describe_localizers(ParamVisitor& v, MissionSetup& setup) {
  const auto known = names_of(localizers());
  const About run = About("that run").otherwise("the cheap ones that suit robot and world");
  const About primary = "the localizer that closes the loop; `vigia help localizers` has a table";
  if (v.reader() != nullptr && v.reader()->has("localizers")) {
    v.names("localizers", setup.localizers, known, run);
    if (!contains(setup.localizers, setup.primary)) setup.primary = setup.localizers.front();
    v.name("primary", setup.primary, setup.localizers, primary);
    require_fit(v, "localizers", setup);
    return;
  }
  setup.localizers = usual_localizers(setup);
  const bool blind = !find_name(localizers(), setup.primary)->fits(setup);
  if (v.reader() != nullptr && blind && !setup.localizers.empty()) {
    const auto sighted = std::find_if(setup.localizers.begin(), setup.localizers.end(),
                                      [](const std::string& name) { return name != "odometry"; });
    setup.primary = sighted == setup.localizers.end() ? setup.localizers.front() : *sighted;
  }
  v.name("primary", setup.primary, known, primary);
  if (!contains(setup.localizers, setup.primary)) setup.localizers.push_back(setup.primary);
  require_fit(v, "primary", setup);
  v.names("localizers", setup.localizers, known, run);
}

/// Whom the ceiling's flow moves: the localizer of its patches, unless others are named.
void describe_ceiling(ParamVisitor& v, MissionSetup& setup) {
  setup.ceiling.odometry = setup.noise.odometry;
  const auto camera = ceiling_camera(setup);
  v.require(!camera || camera->rise_m() > kLeastRise_m, "ceiling",
            "the world's ceiling must hang above the camera that looks up at it");
  // As the camera is truly mounted, unless the mission says otherwise.
  if (const auto& mounting = setup.disturbances.mounting; mounting && camera) {
    setup.ceiling.tilt_sigma = setup.ceiling.mount_yaw_sigma = mounting->angle;
    setup.ceiling.mount_sigma_m = mounting->offset_m;
    setup.ceiling.height_sigma = mounting->offset_m / camera->rise_m();
  }
  v.map("ceiling", setup.ceiling, "the localizer under a patched ceiling, and the ceiling's flow");
  std::vector<std::string> known = names_of(localizers());
  known.emplace_back(kNobody);
  setup.flow = {contains(setup.localizers, "ceiling") ? "ceiling" : kNobody};
  v.names("flow", setup.flow, known,
          About("the localizers that the flow of the ceiling moves on beside the odometry")
              .otherwise("`[ceiling]` where that runs"));
  v.require(setup.flow.size() == 1 || !contains(setup.flow, kNobody), "flow",
            "'none' stands alone");
  if (v.reader() == nullptr || !v.reader()->has("flow")) return;
  for (const std::string& name : setup.flow)
    v.require(name == kNobody || contains(setup.localizers, name), "flow",
              "'" + name + "' is not among the localizers that run");
}

void describe_localization(ParamVisitor& v, MissionSetup& setup) {
  describe_localizers(v, setup);
  // Matched to the robot unless the mission says otherwise.
  setup.noise.odometry = setup.robot.robot.odometry;
  setup.noise.sensor = setup.robot.robot.sensor;
  v.map("noise", setup.noise,
        "what the robot believes of its sensors' errors; a localizer's own keys override it");
  setup.ekf.odometry = setup.noise.odometry;
  setup.ekf.sensor = setup.noise.sensor;
  setup.ekf.centre_floor_px = setup.noise.centre_floor_px;
  setup.ekf.size_floor = setup.noise.size_floor;
  v.map("ekf", setup.ekf, "the extended Kalman filter");
  setup.bearing_only.odometry = setup.noise.odometry;
  setup.bearing_only.sensor = setup.noise.sensor;
  v.map("bearing_only", setup.bearing_only, "the localizer that learns from bearings alone");
  v.where(ceiling_camera(setup).has_value(),
          "the world has a `ceiling` and a fixed camera looks up at it",
          [&] { describe_ceiling(v, setup); });
}

/// Eyes for landmarks read pinhole images, the eye for a field those of a mirror in colour;
/// patterns are told apart by their colours.
void require_cameras(ParamVisitor& v, const MissionSetup& setup) {
  const auto& cameras = setup.robot.cameras;
  const auto upward =
      std::count_if(cameras.begin(), cameras.end(),
                    [](const sim::CameraSetup& camera) { return looks_up(camera.camera); });
  v.require(
      !setup.world.ceiling || upward < 2, "robot",
      std::to_string(upward) +
          " cameras look up at the world's ceiling; its localizer reads one of them, and only "
          "one may be there");
  const auto& landmarks = setup.world.landmarks.all();
  const bool patterns =
      std::any_of(landmarks.begin(), landmarks.end(), [](const Landmark& landmark) {
        return std::holds_alternative<PatternShape>(landmark.shape);
      });
  for (const sim::CameraSetup& camera : setup.robot.cameras) {
    const bool omni = !zoom_calibration(camera.camera.optics).has_value();
    v.require(!omni || setup.world.field.has_value(), "robot",
              "camera " + std::to_string(camera.camera.id) +
                  " is omnidirectional, and the eye that reads such images needs a `field` in the "
                  "world; `vigia help eyes` lists the eyes");
    v.require(!omni || (camera.imaging.colour && !on_head(camera.camera)), "robot",
              "camera " + std::to_string(camera.camera.id) +
                  " is omnidirectional: the eye that reads its images needs mount: fixed and "
                  "colour: true");
    v.require(camera.imaging.colour || !patterns, "robot",
              "the world has colour patterns, but the robot's camera sees grey: it needs "
              "camera.colour: true");
  }
}

std::string seconds_text(Duration time) {
  return fmt::format("{:g} s", time.seconds());
}

/// What comes later than a localizer remembers is lost to it.
void require_in_time(ParamVisitor& v, const MissionSetup& setup) {
  if (v.reader() == nullptr) return;
  const Rig rig = setup.robot.rig();
  for (const Camera& camera : rig.cameras) {
    const Duration delay = longest_delay(setup, camera);
    const std::string late = fmt::format(
        "images of camera {} come up to {} late (its latency_s, and latency_s, processing_s and "
        "the wait for it of disturbances.latency)",
        camera.id, seconds_text(delay));
    for (const std::string& name : setup.localizers) {
      const LateImages& taken = find_name(localizers(), name)->late;
      if (eye_of(camera, setup.world, rig) != taken.eye) continue;
      const Duration history = taken.history(setup);
      v.require(delay <= history, "localization",
                fmt::format("{}, and '{}' remembers {}{}", late, name, seconds_text(history),
                            taken.key.empty() ? "" : fmt::format(" ({})", taken.key)));
    }
    const bool waited_for =
        std::any_of(setup.flow.begin(), setup.flow.end(),
                    [](const std::string& name) { return name != "ceiling" && name != kNobody; });
    const Duration wait = localization::FlowFedLocalizer::longest_wait();
    v.require(
        !waited_for || eye_of(camera, setup.world, rig) != std::string_view("ceiling") ||
            delay <= wait,
        "localization",
        fmt::format("{}, and the localizers of `flow` wait {} for it", late, seconds_text(wait)));
  }
}

/// Above the ceiling nothing of the building is seen.
void require_below_ceiling(ParamVisitor& v, const MissionSetup& setup) {
  const double ceiling_m = setup.world.plan.ceiling_m();
  for (const sim::CameraSetup& camera : setup.robot.cameras) {
    const Ground& ground = setup.world.ground;
    const double height_m =
        ground.in_plan((ground.place(setup.start) * camera.camera.rMc({})).translation()).z();
    v.require(height_m < ceiling_m, "robot",
              fmt::format("camera {} is {:g} m above the floor, must be below the room's ceiling "
                          "(room.height_m {:g})",
                          camera.camera.id, height_m, ceiling_m));
  }
}

void describe_planner(ParamVisitor& v, MissionSetup& setup) {
  describe(v, setup.look);
  if (setup.look.policy != "fixed") return;
  const auto& fixed = setup.look.fixed_landmark;
  v.require(fixed.has_value(), "policy", "the policy \"fixed\" needs the key fixed_landmark");
  v.require(setup.world.landmarks.find(*fixed) != nullptr, "fixed_landmark",
            "found " + std::to_string(*fixed) + ", which is no landmark of the world");
}

/// A rate of more than the whole error in a tick swings about its goal.
void require_steady(ParamVisitor& v, const char* what, double gain, double tick_s) {
  v.require(gain * tick_s <= 1.0, "gaze",
            fmt::format("{} {:g} /s takes more than the whole error away in a tick of {:g} s and "
                        "swings: at rate_hz {:g} it may be {:g} at most",
                        what, gain, tick_s, 1.0 / tick_s, 1.0 / tick_s));
}

/// The gains' defaults leave a slow loop a fifth of its error.
void describe_gaze(ParamVisitor& v, MissionSetup& setup) {
  constexpr double kShareInATick = 0.8;
  setup.gaze.aim_gain = std::min(setup.gaze.aim_gain, kShareInATick / setup.tick_s);
  setup.gaze.servo.gain = std::min(setup.gaze.servo.gain, kShareInATick / setup.tick_s);
  v.map("gaze", setup.gaze, "how head and zoom follow an order");
  require_steady(v, "aim_gain", setup.gaze.aim_gain, setup.tick_s);
  require_steady(v, "servo.gain", setup.gaze.servo.gain, setup.tick_s);
}

void describe_pilot(ParamVisitor& v, MissionSetup& setup) {
  describe(v, setup.pilot.follower);
  v.where(setup.robot.range_ring.has_value(), "the robot has a `range_ring`", [&] {
    // Matched to the robot's ring unless the mission says otherwise.
    const sim::RangeRingParams ring = setup.robot.range_ring.value_or(sim::RangeRingParams{});
    setup.pilot.ring.half_angle_deg = 0.5 * to_deg(ring.cone);
    setup.pilot.ring.sigma_m = ring.sigma_m;
    setup.pilot.ring.sigma_relative = ring.sigma_relative;
    v.map("ring", setup.pilot.ring, "how the ring of range sensors is read");
  });
  v.map("avoidance", setup.pilot.avoidance, "how unknown obstacles are dealt with");
}

void describe_run(ParamVisitor& v, MissionSetup& setup) {
  v.integer("seed", setup.seed, {0, 9e15}, "of every random stream; `--seed` overrides");
  double rate_hz = 1.0 / setup.tick_s;
  v.number("rate_hz", rate_hz, {5.0, 200.0}, "ticks, frames and odometry readings");
  setup.tick_s = 1.0 / rate_hz;
  v.number("timeout_s", setup.timeout_s, {1.0, 1e5}, "outcome `timeout` after this");
  v.number("goal_tolerance_m", setup.goal_tolerance_m, {0.01, 10.0},
           "of the true robot at the end, for the outcome `arrived`");
  v.boolean("full_frames", setup.full_frames,
            "compute every pixel of every frame (for comparison)");
  v.integer("recorded_frames", setup.recorded_frames, {0, 1000},
            "camera pictures in the run folder");
}

}  // namespace

void describe(ParamVisitor& v, MissionSetup& setup) {
  v.folder_name("name", setup.name, About("its run folder is named after it").required());
  v.map_or_file("world", "the building", [&] { describe_world(v, setup); });
  v.map_or_file("robot", "base, head and camera", [&] { describe(v, setup.robot); });
  setup.world.ground = setup.world.ground.under(setup.robot.robot.stance());
  v.map("disturbances", "what the true world does and the robot's model leaves out", [&] {
    describe(v, setup.disturbances);
    v.where(!setup.world.ground.patches().empty(), "the world has `ground`", [&] {
      v.toggle("ramp_error", setup.disturbances.ramp_error, false,
               "ramps that are not as the map has them");
    });
  });
  describe_run(v, setup);
  v.map("start", "where the drive begins", [&] { describe_start(v, setup); });
  v.name("tracker", setup.tracker, tracking::ellipse_tracker_names(),
         "of discs; `vigia help trackers` tells them apart");
  v.map("localization", "who estimates the pose", [&] { describe_localization(v, setup); });
  require_in_time(v, setup);
  v.map("planner", "when and where the robot looks", [&] { describe_planner(v, setup); });
  require_cameras(v, setup);
  require_below_ceiling(v, setup);
  setup.gaze.look_angle = setup.noise.sensor.look_angle;
  describe_gaze(v, setup);
  v.map("pilot", "how the base follows the route", [&] { describe_pilot(v, setup); });
  v.map("recovery", setup.recovery, "what a lost robot does");
  v.map("route", "the drive", [&] { describe_route(v, setup); });
}

namespace {

/// All but the route.
MissionSetup read_mission(MapReader& mission, const ConfigNode& root) {
  MissionSetup setup;
  ParamReader visitor(mission);
  describe(visitor, setup);
  mission.finish();
  setup.resolved_yaml = dump_config(root);
  return setup;
}

}  // namespace

std::vector<KeyRow> mission_keys() {
  return key_reference<MissionSetup>("");
}

MissionSetup load_mission(const std::filesystem::path& file,
                          const std::vector<std::string>& overrides) {
  const auto root = load_config(file);
  for (const auto& assignment : overrides) set_config(*root, assignment);
  MapReader mission(root, "mission");
  MissionSetup setup = read_mission(mission, *root);
  plan_mission_route(mission.map("route"), setup);
  return setup;
}

MissionSetup load_planned_mission(const std::filesystem::path& file, const Path& route) {
  const auto root = load_config(file);
  MapReader mission(root, "mission");
  MissionSetup setup = read_mission(mission, *root);
  setup.route.robot_radius_m = setup.robot.robot.radius_m;
  setup.path = route;
  return setup;
}

}  // namespace vigia::mission
