#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

class RecoveryEvents : public Listener {
 public:
  void on_event(const Event& event) override { kinds.push_back(event.kind); }
  bool has(EventKind kind) const {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  }
  std::vector<EventKind> kinds;
};

MissionSetup mission_with_prior_off_by(const Pose2& offset) {
  MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml");
  setup.prior->pose = compose(setup.start, offset);
  return setup;
}

TEST(Recovery, ARobotThatWasToldAWrongStartSaysItIsLostFindsItselfAndArrives) {
  const MissionSetup setup = mission_with_prior_off_by({0.3, -0.3, from_deg(-15)});
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RecoveryEvents log;
    evaluation::DriveScorer scorer;
    const Outcome outcome = run_mission(setup, seed, {&log, &scorer});
    EXPECT_EQ(outcome, Outcome::arrived) << "seed " << seed;
    EXPECT_TRUE(log.has(EventKind::lost)) << "seed " << seed;
    EXPECT_TRUE(log.has(EventKind::recovered)) << "seed " << seed;
    EXPECT_LT(scorer.score().localizers.at("ekf").position_final_m, 0.05) << "seed " << seed;
    EXPECT_GT(scorer.score().localizers.at("ekf").lost_s, 0.0) << "seed " << seed;
  }
}

TEST(Recovery, ARobotWithoutAPriorStartsLostFindsItselfAndArrives) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                   {"start.prior=false", "localization.localizers=[ekf, bearing_only]"});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    evaluation::DriveScorer scorer;
    EXPECT_EQ(run_mission(setup, seed, {&scorer}), Outcome::arrived) << "seed " << seed;
    const auto& ekf = scorer.score().localizers.at("ekf");
    EXPECT_GE(ekf.loss.right_recoveries, 1) << "seed " << seed;
    EXPECT_EQ(ekf.loss.wrong_recoveries, 0) << "seed " << seed;
    EXPECT_EQ(ekf.loss.false_alarms, 0) << "seed " << seed;
    EXPECT_LT(ekf.position_final_m, 0.05) << "seed " << seed;
    const auto& bearings = scorer.score().localizers.at("bearing_only");
    EXPECT_GT(bearings.lost_s + bearings.loss.ambiguous_s, 0.0) << "seed " << seed;
    EXPECT_EQ(bearings.loss.wrong_recoveries, 0) << "seed " << seed;
  }
}

TEST(Recovery, BearingsAloneDriveARobotToItsGoal) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                   {"localization.localizers=[bearing_only]"});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    evaluation::DriveScorer scorer;
    EXPECT_EQ(run_mission(setup, seed, {&scorer}), Outcome::arrived) << "seed " << seed;
    EXPECT_LT(scorer.score().localizers.at("bearing_only").position_rmse_m, 0.15)
        << "seed " << seed;
  }
}

TEST(Recovery, TwoLandmarksThatAreNotThereSufficeWhereThereIsNoThirdToLookAt) {
  const std::string discs =
      "world.landmarks=[{id: 0, kind: disc, centre_m: [3.4, 3.2, 1.6], normal_deg: 180, radius_m: "
      "0.1}, {id: 4, kind: disc, centre_m: [0, 3.6, 1.9], normal_deg: 0, radius_m: 0.1}]";
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                   {discs, "disturbances.missing_landmarks={probability: 1, at_most_one_in: 1}",
                    "planner.exclude_s=60", "timeout_s=30"});
  RecoveryEvents log;
  run_mission(setup, 1, {&log});
  const auto lost = std::find(log.kinds.begin(), log.kinds.end(), EventKind::lost);
  ASSERT_NE(lost, log.kinds.end());
  EXPECT_EQ(std::count(log.kinds.begin(), lost, EventKind::expired), 2);
}

/// The fastest that a robot drives from a second after its first failed look until it says lost.
class Suspicion : public Listener {
 public:
  void on_event(const Event& event) override {
    if (event.kind == EventKind::expired && !since_s) since_s = event.stamp.seconds();
    if (event.kind == EventKind::lost) lost = true;
  }
  void on_tick(const Tick& tick) override {
    const double now_s = tick.estimator.now.seconds();
    if (since_s && !lost && now_s > *since_s + 1.0)
      fastest_mps = std::max(fastest_mps, std::abs(tick.base_command.v));
  }
  std::optional<double> since_s;
  bool lost = false;
  double fastest_mps = 0.0;
};

TEST(Recovery, WithoutARingARobotDoesNotDriveOnWhereALandmarkWasNotAndThereIsNoOther) {
  const std::string disc =
      "world.landmarks=[{id: 0, kind: disc, centre_m: [3.4, 3.2, 1.6], normal_deg: 180, radius_m: "
      "0.1}]";
  MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                   {disc, "disturbances.missing_landmarks={probability: 1, at_most_one_in: 1}",
                    "planner.exclude_s=60", "timeout_s=30"});
  setup.robot.range_ring.reset();
  Suspicion blind;
  run_mission(setup, 1, {&blind});
  ASSERT_TRUE(blind.since_s);
  EXPECT_TRUE(blind.lost);
  EXPECT_EQ(blind.fastest_mps, 0.0);
}

TEST(Recovery, WithoutARingARobotThatIsTakenAwayInTheMiddleOfALookDoesNotDriveOnAfterIt) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/quixote-room.yaml",
                   {"disturbances.kidnapping=realistic"});
  RecoveryEvents log;
  EXPECT_EQ(run_mission(setup, 134, {&log}), Outcome::arrived);
  EXPECT_TRUE(log.has(EventKind::target_lost));
  EXPECT_TRUE(log.has(EventKind::recovered));
}

TEST(Recovery, ARobotThatSeesNoLandmarkGivesUpAndSaysSo) {
  MissionSetup setup = mission_with_prior_off_by({});
  // A belief that is lost at once, and a sweep that looks at the floor.
  setup.ekf.lost_sigma_m = 1e-4;
  setup.recovery.sweeps = 1;
  setup.recovery.tilt = from_deg(-80);
  RecoveryEvents log;
  EXPECT_EQ(run_mission(setup, 1, {&log}), Outcome::lost);
  EXPECT_TRUE(log.has(EventKind::lost));
  EXPECT_FALSE(log.has(EventKind::recovered));
}

/// What happened on the way from being lost to being found.
class Search : public Listener {
 public:
  void on_event(const Event& event) override {
    const auto number = [&](const std::string& key) {
      for (const auto& [name, value] : event.numbers)
        if (name == key) return value;
      return std::nan("");
    };
    if (event.kind == EventKind::exploration) exploration_m.push_back(number("length_m"));
    if (event.kind == EventKind::exploration) explored_m.push_back(0.0);
    if (event.kind == EventKind::looked_around) hypotheses.push_back(number("hypotheses"));
    if (event.kind == EventKind::lost) lost_s = event.stamp.seconds();
    searching = (searching || event.kind == EventKind::lost) && event.kind != EventKind::recovered;
    just_found = just_found || event.kind == EventKind::recovered;
  }
  void on_tick(const Tick& tick) override {
    const double driven =
        (tick.truth.pose.position() - tick.estimator.truth->pose_before.position()).norm();
    if (searching && !explored_m.empty()) explored_m.back() += driven;
    if (searching && !tick.activations)
      most_in_sweep_mps = std::max(most_in_sweep_mps, std::abs(tick.base_command.v));
    if (!just_found) return;
    just_found = false;
    const Belief& belief = tick.estimator.primary_belief();
    const Eigen::Vector3d error = difference(belief.pose, tick.truth.pose);
    distance2.push_back(error.dot(belief.covariance.inverse() * error));
    found_sigma_m = belief.position_sigma();
  }
  std::vector<double> exploration_m;  ///< as the event log has it
  std::vector<double> explored_m;     ///< truly driven from each one's beginning to the next's
  std::vector<double> hypotheses;
  std::vector<double> distance2;  ///< Mahalanobis, of the pose in which it found itself
  double found_sigma_m = 0.0;
  double lost_s = 0.0;
  double most_in_sweep_mps = 0.0;
  bool searching = false;
  bool just_found = false;
};

/// χ² of three degrees of freedom at 99.99 %.
constexpr double kFar2 = 21.1;

/// A robot that is told nothing of its start.
MissionSetup woken(const std::string& mission, const std::vector<std::string>& overrides) {
  MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/" + mission, overrides);
  setup.prior->pose = compose(setup.start, {1.0, -0.5, from_deg(120)});
  setup.prior->covariance = Eigen::Vector3d(9.0, 9.0, 9.0).asDiagonal();
  return setup;
}

TEST(Recovery, ARobotThatWokeAmongPatternsFindsItselfByTheirCodes) {
  const MissionSetup setup = woken("quixote-room.yaml", {"timeout_s=13"});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Search search;
    run_mission(setup, seed, {&search});
    EXPECT_LT(search.lost_s, 0.1) << seed;
    ASSERT_EQ(search.hypotheses, std::vector<double>{1.0}) << seed;
    ASSERT_EQ(search.distance2.size(), 1U) << seed;
    EXPECT_LT(search.distance2[0], kFar2) << seed;
    EXPECT_LT(search.found_sigma_m, 0.1) << seed;
    EXPECT_FALSE(search.searching) << seed;
    EXPECT_EQ(search.most_in_sweep_mps, 0.0) << seed;
  }
}

/// Three seeds' robots know where they are after one search.
void expect_to_find_themselves(const std::string& mission) {
  const MissionSetup setup = woken(mission, {"timeout_s=15"});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Search search;
    run_mission(setup, seed, {&search});
    ASSERT_EQ(search.distance2.size(), 1U) << seed;
    EXPECT_LT(search.distance2[0], kFar2) << seed;
    EXPECT_FALSE(search.searching) << seed;
  }
}

TEST(Recovery, ARobotThatWokeAmongTagsFindsItselfByThem) {
  expect_to_find_themselves("tag-room.yaml");
}

TEST(Recovery, ARobotThatWokeAmongDiscsPatternsAndTagsFindsItselfByAllOfThem) {
  expect_to_find_themselves("mixed-room.yaml");
}

TEST(Recovery, TheTimeThatASearchTakesPassesInTheSimulation) {
  const MissionSetup setup = woken("armingol-room.yaml", {"timeout_s=15"});
  double looked_s = 0.0;
  double took_s = 0.0;
  double recovered_s = 0.0;
  class Times : public Listener {
   public:
    Times(double& looked, double& took, double& recovered)
        : looked_(looked), took_(took), recovered_(recovered) {}
    void on_event(const Event& event) override {
      if (event.kind == EventKind::recovered) recovered_ = event.stamp.seconds();
      if (event.kind != EventKind::looked_around) return;
      looked_ = event.stamp.seconds();
      for (const auto& [name, value] : event.numbers)
        if (name == "took_s") took_ = value;
    }

   private:
    double& looked_;
    double& took_;
    double& recovered_;
  } times(looked_s, took_s, recovered_s);
  run_mission(setup, 1, {&times});
  EXPECT_GT(took_s, 0.0);
  EXPECT_GE(recovered_s - looked_s, took_s);
  EXPECT_LE(recovered_s - looked_s, took_s + setup.tick_s + 1e-9);
}

TEST(Recovery, WhereTooLittleIsSeenItGoesToWhereMoreIs) {
  // Behind the partition wall one disc shows; farther on there are more.
  const MissionSetup setup =
      woken("armingol-room.yaml", {"timeout_s=60", "start={position_m: [3.9, 5.9], heading_deg: 0}",
                                   "route.via_m=[]", "route.goal_m=[1, 5.9]"});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Search search;
    EXPECT_EQ(run_mission(setup, seed, {&search}), Outcome::arrived) << seed;
    ASSERT_GE(search.exploration_m.size(), 1U) << seed;
    ASSERT_EQ(search.hypotheses.size(), search.exploration_m.size() + 1) << seed;
    EXPECT_EQ(search.hypotheses.front(), 0.0) << seed;
    EXPECT_GE(search.hypotheses.back(), 1.0) << seed;
    // It stops within the pilot's tolerance of the end.
    for (std::size_t i = 0; i < search.exploration_m.size(); ++i) {
      EXPECT_LE(search.explored_m[i],
                search.exploration_m[i] + setup.pilot.follower.goal_tolerance_m)
          << seed;
      EXPECT_GE(search.explored_m[i],
                search.exploration_m[i] - 2.0 * setup.pilot.follower.goal_tolerance_m)
          << seed;
    }
    ASSERT_EQ(search.distance2.size(), 1U) << seed;
    EXPECT_LT(search.distance2[0], kFar2) << seed;
    EXPECT_EQ(search.most_in_sweep_mps, 0.0) << seed;
  }
}

TEST(Recovery, ThereIsAnExplorationBetweenTwoSweepsAndNoneAfterTheLast) {
  MissionSetup setup = mission_with_prior_off_by({});
  setup.ekf.lost_sigma_m = 1e-4;
  setup.recovery.sweeps = 3;
  setup.recovery.tilt = from_deg(-80);
  Search search;
  EXPECT_EQ(run_mission(setup, 1, {&search}), Outcome::lost);
  EXPECT_EQ(search.hypotheses.size(), 3U);
  EXPECT_EQ(search.exploration_m.size(), 2U);
}

TEST(Recovery, WithoutARingItStaysWhereItIs) {
  MissionSetup setup = mission_with_prior_off_by({});
  setup.robot.range_ring.reset();
  setup.ekf.lost_sigma_m = 1e-4;
  setup.recovery.sweeps = 2;
  setup.recovery.tilt = from_deg(-80);
  Search search;
  EXPECT_EQ(run_mission(setup, 1, {&search}), Outcome::lost);
  EXPECT_EQ(search.hypotheses.size(), 2U);
  EXPECT_TRUE(search.exploration_m.empty());
}

/// What a kidnapped robot said, over seeds.
struct Kidnappings {
  int said = 0;
  int wrong_recoveries = 0;
  int at_a_wrong_goal = 0;
  double greatest_unsaid_s = 0.0;
};

Kidnappings kidnapped(const std::string& world, const std::string& route, int seeds) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                   {world, route, "planner.policy=fuzzy", "disturbances.kidnapping=realistic",
                    "start={position_m: [1, 1], heading_deg: 0}", "timeout_s=200"});
  Kidnappings counts;
  for (int seed = 1; seed <= seeds; ++seed) {
    evaluation::DriveScorer scorer;
    const Outcome outcome = run_mission(setup, static_cast<std::uint64_t>(seed), {&scorer});
    const auto& score = scorer.score().localizers.at("ekf");
    counts.said += score.loss.said;
    counts.wrong_recoveries += score.loss.wrong_recoveries;
    if (outcome == Outcome::arrived && score.position_final_m > 0.5) ++counts.at_a_wrong_goal;
    counts.greatest_unsaid_s = std::max(counts.greatest_unsaid_s, score.loss.unsaid_s);
  }
  return counts;
}

TEST(Recovery, InARoomThatLooksTheSameFromFourPlacesNoneIsTakenForTheOnlyOne) {
  const Kidnappings counts = kidnapped(
      "world={name: square, room: {width_m: 6, depth_m: 6, height_m: 2.8}, landmarks: ["
      "{id: 1, kind: disc, centre_m: [6, 3, 1.8], normal_deg: 180, radius_m: 0.1}, "
      "{id: 2, kind: disc, centre_m: [3, 6, 1.8], normal_deg: -90, radius_m: 0.1}, "
      "{id: 3, kind: disc, centre_m: [0, 3, 1.8], normal_deg: 0, radius_m: 0.1}, "
      "{id: 4, kind: disc, centre_m: [3, 0, 1.8], normal_deg: 90, radius_m: 0.1}]}",
      "route={goal_m: [5, 5], via_m: [[5, 1], [1, 5], [5, 1.2], [1, 1.2], [1, 5]]}", 6);
  EXPECT_GE(counts.said, 6);
  EXPECT_EQ(counts.wrong_recoveries, 0);
  EXPECT_EQ(counts.at_a_wrong_goal, 0);
}

TEST(Recovery, InACorridorWhereOneLandmarkAtATimeShowsItSaysThatItIsLost) {
  const Kidnappings counts = kidnapped(
      "world={name: corridor, room: {width_m: 26, depth_m: 2, height_m: 2.8}, landmarks: ["
      "{id: 1, kind: disc, centre_m: [3, 2, 1.8], normal_deg: -90, radius_m: 0.1}, "
      "{id: 2, kind: disc, centre_m: [7, 2, 1.8], normal_deg: -90, radius_m: 0.1}, "
      "{id: 3, kind: disc, centre_m: [11, 2, 1.8], normal_deg: -90, radius_m: 0.1}, "
      "{id: 4, kind: disc, centre_m: [15, 2, 1.8], normal_deg: -90, radius_m: 0.1}, "
      "{id: 5, kind: disc, centre_m: [19, 2, 1.8], normal_deg: -90, radius_m: 0.1}, "
      "{id: 6, kind: disc, centre_m: [23, 2, 1.8], normal_deg: -90, radius_m: 0.1}]}",
      "route={goal_m: [25, 1], via_m: []}", 4);
  EXPECT_GE(counts.said, 4);
  EXPECT_EQ(counts.wrong_recoveries, 0);
  EXPECT_EQ(counts.at_a_wrong_goal, 0);
  // Half a turn along the corridor's axis leaves the ring's side beams as they were.
  EXPECT_LT(counts.greatest_unsaid_s, 90.0);
}

TEST(Mission, WithTheServosFeedForwardItsTargetStaysCentred) {
  const MissionSetup setup = load_mission(
      std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
      {"robot.sensor.look_angle_deg=0", "robot.sensor.look_focal=0", "planner.dwell_s=2",
       "robot.zoom.table=[{zoom_mm: 8, focal_px: 699.9}, {zoom_mm: 8.01, focal_px: 700}]"});
  evaluation::DriveScorer scorer;
  run_mission(setup, 1, {&scorer});
  EXPECT_LE(scorer.score().perception.centring_rms_px, 0.5);
}

}  // namespace
}  // namespace vigia::mission
