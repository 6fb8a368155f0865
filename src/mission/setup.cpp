#include "vigia/mission/setup.hpp"

#include "read_params.hpp"

#include <algorithm>

namespace vigia::mission {
namespace {

constexpr Range kMetres{-1e4, 1e4};
constexpr double kLeastRoute_m = 0.01;

void read_start(MapReader start, const sim::RobotSetup& robot, MissionSetup& setup) {
  const Eigen::Vector2d position = start.vector2("position_m", kMetres);
  const double heading = from_deg(start.number("heading_deg", {-360.0, 360.0}));
  setup.start_sigma_m = start.number("sigma_m", {0.0, 5.0}, 0.01);
  setup.start_sigma_rad = from_deg(start.number("sigma_deg", {0.0, 180.0}, 0.2));
  start.finish();
  setup.start = {position.x(), position.y(), wrap_angle(heading)};
  setup.prior.pose = setup.start;
  const double variance = setup.start_sigma_m * setup.start_sigma_m;
  setup.prior.covariance =
      Eigen::Vector3d(variance, variance, setup.start_sigma_rad * setup.start_sigma_rad)
          .asDiagonal();
  if (setup.world.plan.clearance(position) < robot.robot.radius_m)
    throw start.error("position_m", "the robot (radius " + std::to_string(robot.robot.radius_m) +
                                        " m) does not fit here: it would overlap a wall or an "
                                        "obstacle, or stand outside the room");
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

void read_route(MapReader route, MissionSetup& setup) {
  setup.waypoints.push_back(setup.start.position());
  if (route.has("via_m"))
    for (const auto& via : route.points2("via_m", kMetres, 0)) setup.waypoints.push_back(via);
  setup.waypoints.push_back(route.vector2("goal_m", kMetres));
  const bool moves = std::any_of(
      setup.waypoints.begin(), setup.waypoints.end(),
      [&](const auto& p) { return (p - setup.waypoints.front()).norm() > kLeastRoute_m; });
  if (!moves) throw route.error("goal_m", "the route ends where it starts: nothing to drive");
  setup.route.robot_radius_m = setup.robot.robot.radius_m;
  setup.route.clearance_m = route.number("clearance_m", {0.0, 5.0}, setup.route.clearance_m);
  setup.route.iterations =
      static_cast<int>(route.integer("iterations", {1, 1000000}, setup.route.iterations));
  setup.route.spacing_m = route.number("spacing_m", {0.005, 1.0}, setup.route.spacing_m);
  setup.route_seed = static_cast<std::uint64_t>(
      route.integer("seed", {0, 2147483647}, static_cast<std::int64_t>(setup.route_seed)));
  route.finish();
  const planner::Route found =
      planner::plan_route(setup.world.plan, setup.waypoints, setup.route, setup.route_seed);
  if (found.status != planner::RouteStatus::found) report_route_failure(route, found);
  setup.path = found.path;
}

void read_tracker(MapReader& mission, MissionSetup& setup) {
  static const std::vector<std::string> names{"disc", "ellipse", "correlation"};
  setup.tracker = names[mission.choice("tracker", names, 0)];
}

bool is_pattern(const Landmark& landmark) {
  return std::holds_alternative<PatternShape>(landmark.shape);
}

void read_localization(MapReader localization, MissionSetup& setup) {
  std::vector<std::string> names{"ekf", "odometry"};
  const auto& landmarks = setup.world.landmarks.all();
  if (std::any_of(landmarks.begin(), landmarks.end(), is_pattern))
    names.emplace_back("pattern_fix");
  setup.primary = names[localization.choice("primary", names, 0)];
  setup.localizers = names;
  read_ekf(localization.map("ekf"), setup.robot.robot, setup.ekf);
  localization.finish();
}

/// Patterns are told apart by their colours.
void check_colour(const MapReader& mission, const MissionSetup& setup) {
  const auto& landmarks = setup.world.landmarks.all();
  if (setup.robot.imaging.colour || std::none_of(landmarks.begin(), landmarks.end(), is_pattern))
    return;
  throw mission.error("robot",
                      "the world has colour patterns, but the robot's camera sees grey: it needs "
                      "camera.colour: true");
}

void check_fixed_landmark(const MapReader& look, const MissionSetup& setup) {
  if (setup.look.policy != "fixed") return;
  if (!setup.look.fixed_landmark)
    throw look.error("policy", "the policy \"fixed\" needs the key fixed_landmark");
  if (setup.world.landmarks.find(*setup.look.fixed_landmark) == nullptr)
    throw look.error("fixed_landmark", "found " + std::to_string(*setup.look.fixed_landmark) +
                                           ", which is no landmark of the world");
}

}  // namespace

MissionSetup load_mission(const std::filesystem::path& file,
                          const std::vector<std::string>& overrides) {
  const auto root = load_config(file);
  for (const auto& assignment : overrides) set_config(*root, assignment);
  MapReader mission(root, "mission");

  MissionSetup setup;
  setup.name = mission.folder_name("name");

  MapReader world = mission.map_or_file("world");
  setup.world = read_world_map(world);
  setup.appearance = sim::read_appearance(world, setup.world);
  world.finish();

  MapReader robot = mission.map_or_file("robot");
  setup.robot = sim::read_robot_setup(robot);
  robot.finish();

  setup.disturbances = sim::read_disturbances(mission.map("disturbances"));

  setup.seed = static_cast<std::uint64_t>(mission.integer("seed", {0, 9e15}, 1));
  const double rate = mission.number("rate_hz", {5.0, 200.0}, 25.0);
  setup.tick_s = 1.0 / rate;
  setup.timeout_s = mission.number("timeout_s", {1.0, 1e5}, setup.timeout_s);
  setup.goal_tolerance_m = mission.number("goal_tolerance_m", {0.01, 10.0}, setup.goal_tolerance_m);
  setup.full_frames = mission.boolean("full_frames", setup.full_frames);
  setup.recorded_frames =
      static_cast<int>(mission.integer("recorded_frames", {0, 1000}, setup.recorded_frames));

  read_start(mission.map("start"), setup.robot, setup);
  read_tracker(mission, setup);
  read_localization(mission.map("localization"), setup);
  MapReader look = mission.map("planner");
  read_look(look, setup.look);
  check_fixed_landmark(look, setup);
  check_colour(mission, setup);
  read_gaze(mission.map("gaze"), setup.gaze);
  read_pilot(mission.map("pilot"), setup.robot, setup.pilot);
  read_recovery(mission.map("recovery"), setup.recovery);
  read_route(mission.map("route"), setup);
  mission.finish();

  setup.resolved_yaml = dump_config(*root);
  return setup;
}

}  // namespace vigia::mission
