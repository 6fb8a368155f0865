#include <map>
#include <string>

#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/localizers.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

const std::string kHall = std::string(VIGIA_SOURCE_DIR) + "/config/missions/ceiling-hall.yaml";

TEST(CeilingMission, TheRobotKnowsItsPlaceByThePatchesOfTheCeiling) {
  evaluation::DriveScorer scorer;
  run_mission(load_mission(kHall, {"timeout_s=20"}), 1, {&scorer});
  const auto& localizers = scorer.score().localizers;
  const auto& ceiling = localizers.at("ceiling");
  EXPECT_LT(ceiling.position_rmse_m, 0.01);
  EXPECT_LT(ceiling.position_rmse_m, 0.2 * localizers.at("odometry").position_rmse_m);
  EXPECT_GT(ceiling.updates, 480);
  EXPECT_EQ(ceiling.unsupported, 0);
  EXPECT_DOUBLE_EQ(ceiling.lost_s, 0.0);
  EXPECT_GT(ceiling.pcrlb_position_rms_m, 0.0005);
  EXPECT_LT(ceiling.pcrlb_position_rms_m, 0.01);
}

/// What a drive said, and how it ended.
class Told : public Listener {
 public:
  void on_event(const Event& event) override { ++count[event.kind]; }
  void on_tick(const Tick& tick) override {
    const Belief& belief = tick.estimator.primary_belief();
    off_m = (belief.pose.position() - tick.truth.pose.position()).norm();
    sure = belief.status == BeliefStatus::tracking;
    wrong += sure && off_m > 0.4 ? 1 : 0;
  }
  std::map<EventKind, int> count;
  double off_m = 0.0;
  bool sure = false;
  int wrong = 0;  ///< ticks
};

TEST(CeilingMission, PutDownElsewhereInAHallTheRobotWandersUntilItKnowsAndTouchesNoWall) {
  const MissionSetup setup = load_mission(
      kHall,
      {"world.room={width_m: 14, depth_m: 14, height_m: 2.7}",
       "world.ceiling={placement_m: 0.005, placement_deg: 1.3, min_m: [1, 1], max_m: [13, 13]}",
       "start={position_m: [3, 3], heading_deg: 0, sigma_m: 0.05, sigma_deg: 2}",
       "route={via_m: [[11, 3], [11, 11]], goal_m: [3, 11]}", "timeout_s=150",
       "disturbances={kidnapping: {earliest_s: 3, latest_s: 5, min_m: 3}}"});
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Told told;
    const Outcome outcome = run_mission(setup, seed, {&told});
    EXPECT_EQ(outcome, Outcome::arrived) << seed;
    EXPECT_EQ(told.count[EventKind::kidnapped], 1) << seed;
    EXPECT_GE(told.count[EventKind::settled], 1) << seed;
    EXPECT_LT(told.off_m, 0.02) << seed;
    EXPECT_LE(told.wrong, 60) << seed;
  }
}

TEST(CeilingMission, TheCeilingsFlowMovesAnyLocalizerThatTheMissionNames) {
  const auto score_of = [](const std::string& flow) {
    evaluation::DriveScorer scorer;
    run_mission(load_mission(kHall, {"timeout_s=20", "localization.flow=" + flow}), 1, {&scorer});
    return scorer.score().localizers;
  };
  const auto wheels = score_of("[none]").at("odometry");
  const auto flow = score_of("[ceiling, odometry]").at("odometry");
  // Both begin 5 cm and 2° off; what the way adds is another matter.
  EXPECT_LT(flow.pcrlb_position_final_m, 0.8 * wheels.pcrlb_position_final_m);
  EXPECT_LT(flow.nees_mean, 9.0);
  EXPECT_EQ(flow.updates, 0);
  EXPECT_EQ(flow.rejected, 0);
}

TEST(CeilingMission, AFlowNeedsACeilingAndACameraThatLooksUp) {
  try {
    load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                 {"localization.flow=[odometry]"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("ceiling"), std::string::npos) << error.what();
  }
}

TEST(CeilingMission, TheCeilingsLocalizerNeedsACameraThatLooksUp) {
  try {
    load_mission(kHall, {"robot={name: ahead, cameras: [{mount: fixed, focal_px: 500}]}",
                         "localization.localizers=[ceiling]"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("'ceiling' needs a ceiling in the world and a fixed "
                        "camera that looks up"),
              std::string::npos)
        << error.what();
  }
}

TEST(CeilingMission, WithoutAPriorTheLocalizerIsRefused) {
  try {
    load_mission(kHall, {"start.prior=false", "localization.localizers=[ceiling]"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot start without a prior"), std::string::npos)
        << error.what();
  }
}

TEST(CeilingMission, APatchThatIsAsWideAsLongIsRefused) {
  try {
    load_mission(kHall, {"world.ceiling.width_m=0.09"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("longer than wide"), std::string::npos)
        << error.what();
  }
}

TEST(CeilingMission, PipesThatHangBelowTheFloorAreRefused) {
  EXPECT_NO_THROW(
      load_mission(kHall, {"world.appearance.pipe_pitch_m=1", "world.appearance.pipe_drop_m=2.6"}));
  try {
    load_mission(kHall, {"world.appearance.pipe_pitch_m=1", "world.appearance.pipe_drop_m=4"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("pipes hang below the floor"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace vigia::mission
