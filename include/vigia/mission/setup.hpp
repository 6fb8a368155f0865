#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/noise_model.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/localization/bearing_only.hpp"
#include "vigia/localization/ceiling_filter.hpp"
#include "vigia/localization/ekf.hpp"
#include "vigia/pilot/pilot_params.hpp"
#include "vigia/planner/look_trigger.hpp"
#include "vigia/planner/perception_plan.hpp"
#include "vigia/planner/route.hpp"
#include "vigia/planner/visibility.hpp"
#include "vigia/servo/gaze_controller.hpp"
#include "vigia/sim/simulator.hpp"

namespace vigia {
struct KeyRow;
}

namespace vigia::mission {

/// When and how the robot looks.
struct LookParams {
  std::string policy = "fuzzy";
  std::optional<LandmarkId> fixed_landmark;
  planner::LookTriggerParams trigger;
  planner::VisibilityParams visibility;
  double period_s = 0.2;    ///< how often the planner is asked
  double dwell_s = 1.0;     ///< how long a landmark is watched once tracked
  double timeout_s = 8.0;   ///< an order without a feature by then has expired
  double radius_px = 24.0;  ///< apparent semi-major axis of a disc that the zoom holds
  double fill = 0.8;        ///< half the image's height that the zoom fills with a pattern or tag
  double exclude_s = 5.0;   ///< how long a landmark that failed is left out
  int rejections_to_drop = 5;  ///< gated frames in a row after which a look is given up
  int failures_to_lose = 3;    ///< looks in a row that showed nothing, after which belief is lost
  planner::FuzzyRules rules;   ///< of the policy "fuzzy"
  planner::PerceptionParams perception;  ///< of the policy "fuzzy"
};

/// How the robot looks around once it is lost.
struct RecoveryParams {
  double step_fraction = 0.7;    ///< of the horizontal field of view between two stops of the sweep
  double tilt = from_deg(6.0);   ///< of the head during the sweep, rad
  double settle_s = 0.12;        ///< standing still before a picture counts
  double explained_share = 0.5;  ///< of the discs that a sweep shows, by the pose that is believed
  int sweeps = 6;                ///< given up (outcome lost) after so many without a result
  double ring_probability = 0.99;  ///< of being elsewhere, by the ring, at which belief is lost
  double contact_risk = 0.01;  ///< of touching the building, borne while places are not told apart
  double wander_s = 120.0;     ///< given up (outcome lost) by a robot without a head after so long
};

/// A mission, validated.
struct MissionSetup {
  std::string name;
  std::uint64_t seed = 1;  ///< of a single run; an evaluation brings its own
  WorldMap world;
  std::shared_ptr<const sim::Appearance> appearance;
  sim::RobotSetup robot;
  sim::DisturbanceParams disturbances;  ///< of the world, which nobody but the simulator knows

  Pose2 start;                  ///< true start
  std::optional<Prior> prior;   ///< what the localizers are told of it, if anything
  double start_sigma_m = 0.01;  ///< the true start is drawn round `start` with these
  double start_sigma_rad = from_deg(0.2);

  std::vector<Eigen::Vector2d> waypoints;  ///< start, vias, goal
  planner::RouteParams route;
  std::uint64_t route_seed = 1;  ///< of OMPL: one route for every seed of the mission

  double tick_s = 0.04;
  double timeout_s = 600.0;
  double goal_tolerance_m = 0.3;  ///< of the true robot, for the outcome "arrived"

  std::string tracker = "disc";
  std::vector<std::string> localizers;
  std::string primary = "ekf";
  NoiseModel noise;  ///< what the robot believes of its sensors
  localization::EkfParams ekf;
  localization::BearingOnlyParams bearing_only;
  localization::CeilingFilterParams ceiling;
  /// Of the localizers those that the ceiling's flow moves on beside the odometry, or "none".
  std::vector<std::string> flow;
  LookParams look;
  servo::GazeParams gaze;
  pilot::PilotParams pilot;
  RecoveryParams recovery;
  bool full_frames = false;  ///< compute every pixel of every frame, for comparison
  int recorded_frames = 8;   ///< camera pictures kept in the run folder

  Path path;                  ///< planned, the same for every seed
  std::string resolved_yaml;  ///< the whole mission with every default written out

  /// What places the robot's cameras in the world, as the robot knows it.
  RigOnGround on_ground() const { return {robot.rig(), world.ground}; }
};

/// The reference of a mission's keys, with those of its world and robot.
std::vector<KeyRow> mission_keys();

/// Reads and validates a mission file with command-line overrides ("key.path=value"), and plans its
/// route. Throws InputError: anything wrong in the files, a start in an obstacle, no route, ….
MissionSetup load_mission(const std::filesystem::path& file,
                          const std::vector<std::string>& overrides = {});

/// Reads a mission whose route was planned before: plans none.
MissionSetup load_planned_mission(const std::filesystem::path& file, const Path& route);

}  // namespace vigia::mission
