#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "vigia/mission/mission.hpp"
#include "vigia/mission/run_folder.hpp"

namespace vigia::mission {
namespace {

/// A counter below the camera with two ways round it: along the front 7 m, round the back 13 m.
/// Somebody who stays where he is fits into the front passage alone, and nobody gets past him.
constexpr const char* kHall = R"(
version: 1
name: hall
world:
  name: hall
  room: {width_m: 8, depth_m: 4, height_m: 2.8}
  obstacles:
    - {polygon_m: [[1.05, 1.2], [6.95, 1.2], [6.95, 2.95], [1.05, 2.95]], height_m: 0.75}
  landmarks:
    - {id: 0, kind: disc, centre_m: [0, 2, 1.6], normal_deg: 0, radius_m: 0.1}
    - {id: 1, kind: disc, centre_m: [8, 2, 1.6], normal_deg: 180, radius_m: 0.1}
    - {id: 2, kind: disc, centre_m: [2, 0, 1.7], normal_deg: 90, radius_m: 0.1}
    - {id: 3, kind: disc, centre_m: [6, 0, 1.7], normal_deg: 90, radius_m: 0.1}
    - {id: 4, kind: disc, centre_m: [2.5, 4, 1.8], normal_deg: -90, radius_m: 0.1}
    - {id: 5, kind: disc, centre_m: [5.5, 4, 1.8], normal_deg: -90, radius_m: 0.1}
start: {position_m: [0.55, 0.6], heading_deg: 0}
route: {goal_m: [7.45, 0.6]}
planner: {policy: nearest, trigger: {kind: distance, distance_m: 0.7}}
disturbances: {people: {count: 1, radius_m: 0.5, height_m: 0.5, speed_mps: 0}}
)";

/// What the pilot's supervisor said at most.
class Say : public Listener {
 public:
  void on_tick(const Tick& tick) override {
    if (tick.activations) hold = std::max(hold, tick.activations->hold);
  }
  double hold = 0.0;
};

class BlockedRoute : public ::testing::Test {
 protected:
  MissionSetup hall(const std::vector<std::string>& overrides = {}) const {
    const auto file = dir_.path() / "hall.yaml";
    std::ofstream(file) << kHall << "robot: " << VIGIA_SOURCE_DIR << "/config/robots/b21.yaml\n";
    return load_mission(file, overrides);
  }
  Outcome drive(const MissionSetup& setup, std::uint64_t seed) {
    RunFolder recorder(dir_.path() / "run");
    const Outcome outcome = run_mission(setup, seed, {&recorder, &say_});
    recorder.folder().commit();
    return outcome;
  }
  /// The lines of events.jsonl about this.
  std::vector<nlohmann::json> told(const std::string& kind) const {
    std::vector<nlohmann::json> found;
    std::istringstream lines(vigia::testing::read_text(dir_.path() / "run/events.jsonl"));
    for (std::string line; std::getline(lines, line);)
      if (auto event = nlohmann::json::parse(line); event["event"] == kind)
        found.push_back(std::move(event));
    return found;
  }
  vigia::testing::TempDir dir_;
  Say say_;
};

TEST_F(BlockedRoute, ByWhatTheMapLacksIsPlannedAnewAndTheStorySaysWhy) {
  const MissionSetup setup = hall();
  EXPECT_NEAR(setup.path.length(), 6.9, 0.1);
  // With these seeds he stands in the front passage, not at its end before the goal.
  for (std::uint64_t seed = 4; seed <= 6; ++seed) {
    say_ = {};
    EXPECT_EQ(drive(setup, seed), Outcome::arrived) << seed;
    const auto plans = told("replan");
    ASSERT_EQ(plans.size(), 1U) << seed;
    EXPECT_EQ(plans[0]["reason"], "blocked") << seed;
    EXPECT_GT(plans[0]["length_m"], 10.0) << seed;
    const auto blocked = told("blocked");
    ASSERT_EQ(blocked.size(), 1U) << seed;
    EXPECT_EQ(blocked[0]["t_s"], plans[0]["t_s"]) << seed;
    EXPECT_NEAR(blocked[0]["y_m"], 0.6, 0.3) << seed;
    EXPECT_FALSE(told("wait").empty()) << seed;
    EXPECT_TRUE(told("collided").empty()) << seed;
    EXPECT_GT(say_.hold, 0.5) << seed;
  }
}

TEST_F(BlockedRoute, WithNobodyInItIsDrivenAsPlanned) {
  EXPECT_EQ(drive(hall({"disturbances.people=off"}), 4), Outcome::arrived);
  EXPECT_TRUE(told("replan").empty());
  EXPECT_TRUE(told("wait").empty());
  EXPECT_EQ(say_.hold, 0.0);
}

TEST_F(BlockedRoute, APointToPassOnWhichSomebodyStandsIsToldToBeMissed) {
  const MissionSetup setup = hall({"route.via_m=[[3.1, 0.6]]"});
  EXPECT_EQ(drive(setup, 4), Outcome::arrived);
  const auto missed = told("via_missed");
  ASSERT_EQ(missed.size(), 1U);
  EXPECT_NEAR(missed[0]["x_m"], 3.1, 1e-9);
  EXPECT_GT(missed[0]["nearest_m"], 0.27);
}

TEST_F(BlockedRoute, PointsThatWerePassedAreNotToldToBeMissed) {
  EXPECT_EQ(drive(hall({"disturbances.people=off", "route.via_m=[[3.1, 0.6], [5, 0.6]]"}), 4),
            Outcome::arrived);
  EXPECT_TRUE(told("via_missed").empty());
}

TEST_F(BlockedRoute, WithoutAnotherWayIsGivenUp) {
  // A wall closes the way round the back.
  const MissionSetup setup =
      hall({"world.walls=[{from_m: [4, 2.95], to_m: [4, 4]}]", "pilot.avoidance.give_up_s=20"});
  EXPECT_EQ(drive(setup, 4), Outcome::stuck);
  const auto stuck = told("stuck");
  ASSERT_FALSE(stuck.empty());
  EXPECT_EQ(stuck[0]["reason"], "the path stays blocked and there is no way round");
  EXPECT_TRUE(told("replan").empty());
}

}  // namespace
}  // namespace vigia::mission
