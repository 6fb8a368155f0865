#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

class RealisticEvents : public Listener {
 public:
  void on_event(const Event& event) override { ++count[event.kind]; }
  void on_tick(const Tick& tick) override {
    const auto& observations_now = tick.estimator.observations;
    for (std::size_t i = 0; i < observations_now.size(); ++i) {
      const Shot& shot = shot_of(observations_now[i]);
      ++observations;
      late_by = tick.estimator.now - shot.stamp;
      if (tick.estimator.truth->exposures[i].stamp != shot.stamp) ++mismatched;
      if (shot.look != tick.attention->look) ++of_another_look;
    }
  }
  std::map<EventKind, int> count;
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
  RealisticEvents log;
  run_mission(setup, 1, {&log});
  EXPECT_GT(log.observations, 50);
  EXPECT_EQ(log.late_by.ns, 80'000'000);
  EXPECT_EQ(log.mismatched, 0);
  EXPECT_EQ(log.of_another_look, 0);
}

TEST(Realistic, LatencyAloneLeavesTheTargetCentred) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                   {"disturbances.latency=realistic", "planner.dwell_s=2"});
  RealisticEvents log;
  evaluation::DriveScorer scorer;
  EXPECT_EQ(run_mission(setup, 1, {&log, &scorer}), Outcome::arrived);
  EXPECT_EQ(log.late_by.ns, 80'000'000);
  // Without latency it is 0.3 px; a servo that swings would be off by tens.
  EXPECT_LE(scorer.score().perception.centring_rms_px, 1.5);
}

TEST(Realistic, AKidnappedRobotSaysThatItIsLost) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                   {"disturbances.kidnapping={earliest_s: 20, latest_s: 30}", "timeout_s=150"});
  RealisticEvents log;
  evaluation::DriveScorer scorer;
  run_mission(setup, 3, {&log, &scorer});
  EXPECT_EQ(log.count[EventKind::kidnapped], 1);
  EXPECT_GE(log.count[EventKind::lost], 1);
}

}  // namespace
}  // namespace vigia::mission
