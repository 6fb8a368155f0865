#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

class RealisticStory : public Listener {
 public:
  void on_event(const Event& event) override { ++count[event.kind]; }
  void on_tick(const Tick& tick) override {
    if (tick.observation == nullptr) return;
    ++observations;
    late_by = tick.now - shot_of(*tick.observation).stamp;
    if (tick.truth_at_exposure.stamp != shot_of(*tick.observation).stamp) ++mismatched;
    if (shot_of(*tick.observation).look != tick.look) ++of_another_look;
  }
  std::map<std::string, int> count;
  int observations = 0;
  int mismatched = 0;
  int of_another_look = 0;
  Duration late_by;
};

MissionSetup realistic(const std::vector<std::string>& overrides = {}) {
  return load_mission(
      std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room-realistic.yaml", overrides);
}

std::string summary_of(const MissionSetup& setup, std::uint64_t seed) {
  evaluation::DriveScorer scorer;
  run_mission(setup, seed, {&scorer});
  return evaluation::summary_json(scorer.score());
}

TEST(Realistic, ADriveRunsToItsEndAndTheSameSeedGivesTheSameBytes) {
  const MissionSetup setup = realistic();
  const std::string first = summary_of(setup, 1);
  EXPECT_EQ(first, summary_of(setup, 1));
  EXPECT_NE(first, summary_of(setup, 2));
}

TEST(Realistic, FramesArriveLateAndBelongToTheirExposureAndTheirLook) {
  const MissionSetup setup = realistic({"timeout_s=30"});
  RealisticStory story;
  run_mission(setup, 1, {&story});
  EXPECT_GT(story.observations, 50);
  EXPECT_EQ(story.late_by.ns, 80'000'000);
  EXPECT_EQ(story.mismatched, 0);
  EXPECT_EQ(story.of_another_look, 0);
}

TEST(Realistic, LatencyAloneLeavesTheTargetCentred) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                   {"disturbances.latency=realistic", "planner.dwell_s=2"});
  RealisticStory story;
  evaluation::DriveScorer scorer;
  EXPECT_EQ(run_mission(setup, 1, {&story, &scorer}), Outcome::arrived);
  EXPECT_EQ(story.late_by.ns, 80'000'000);
  // Without latency it is 0.3 px; a servo that swings would be off by tens.
  EXPECT_LE(scorer.score().perception.centring_rms_px, 1.5);
}

TEST(Realistic, AKidnappedRobotSaysThatItIsLost) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                   {"disturbances.kidnapping={earliest_s: 20, latest_s: 30}", "timeout_s=150"});
  RealisticStory story;
  evaluation::DriveScorer scorer;
  run_mission(setup, 3, {&story, &scorer});
  EXPECT_EQ(story.count["kidnapped"], 1);
  EXPECT_GE(story.count["lost"], 1);
}

}  // namespace
}  // namespace vigia::mission
