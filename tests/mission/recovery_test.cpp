#include <algorithm>

#include <gtest/gtest.h>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

class Story : public Listener {
 public:
  void on_event(const Event& event) override { kinds.push_back(event.kind); }
  bool tells(const std::string& kind) const {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  }
  std::vector<std::string> kinds;
};

MissionSetup mission_with_prior_off_by(const Pose2& offset) {
  MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml");
  setup.prior.pose = compose(setup.start, offset);
  return setup;
}

TEST(Recovery, ARobotThatWasToldAWrongStartSaysItIsLostFindsItselfAndArrives) {
  const MissionSetup setup = mission_with_prior_off_by({0.3, -0.3, from_deg(-15)});
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Story story;
    evaluation::DriveScorer scorer;
    const Outcome outcome = run_mission(setup, seed, {&story, &scorer});
    EXPECT_EQ(outcome, Outcome::arrived) << "seed " << seed;
    EXPECT_TRUE(story.tells("lost")) << "seed " << seed;
    EXPECT_TRUE(story.tells("recovered")) << "seed " << seed;
    EXPECT_LT(scorer.score().localizers.at("ekf").position_final_m, 0.05) << "seed " << seed;
    EXPECT_GT(scorer.score().localizers.at("ekf").lost_s, 0.0) << "seed " << seed;
  }
}

TEST(Recovery, ARobotThatSeesNoLandmarkGivesUpAndSaysSo) {
  MissionSetup setup = mission_with_prior_off_by({});
  // A belief that is lost at once, and a sweep that looks at the floor.
  setup.ekf.lost_sigma_m = 1e-4;
  setup.recovery.sweeps = 1;
  setup.recovery.tilt = from_deg(-80);
  Story story;
  EXPECT_EQ(run_mission(setup, 1, {&story}), Outcome::stuck);
  EXPECT_TRUE(story.tells("lost"));
  EXPECT_FALSE(story.tells("recovered"));
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
