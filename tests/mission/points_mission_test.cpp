#include <set>

#include <gtest/gtest.h>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

/// Which landmarks a drive has looked at, and with how many planned zooms.
class Looks : public Listener {
 public:
  void on_event(const Event& event) override {
    if (event.kind != EventKind::look) return;
    for (const auto& [name, value] : event.numbers) {
      if (name == "landmark") landmarks.insert(static_cast<LandmarkId>(value));
      if (name == "zoom_mm") ++planned;
    }
  }
  std::set<LandmarkId> landmarks;
  int planned = 0;
};

/// Ticks whose localizers took in an observation, and those of them that are told without it.
class Updates : public Listener {
 public:
  void on_tick(const Tick& tick) override {
    const EstimatorTick& estimator = tick.estimator;
    for (const LocalizerTick& localizer : estimator.localizers) {
      count += static_cast<int>(localizer.updates.size());
      if (localizer.updates.size() != estimator.observations.size()) ++untold;
    }
    for (const Observation& observation : estimator.observations)
      if (shot_of(observation).look != tick.attention->look) ++untold;
  }
  void on_event(const Event& event) override {
    dropped += event.kind == EventKind::dropped ? 1 : 0;
  }
  int count = 0;
  int untold = 0;
  int dropped = 0;
};

class PointsMission : public ::testing::TestWithParam<const char*> {
 protected:
  MissionSetup setup() const {
    return load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/" + GetParam() + ".yaml",
                        {"planner.policy=fuzzy"});
  }
};

// Thrice the bound's rms: a drive's few looks make its rms scatter by some 30 %.
TEST_P(PointsMission, TheFuzzyPlannerDrivesOnPatternsAndTags) {
  Looks looks;
  evaluation::DriveScorer scorer;
  EXPECT_EQ(run_mission(setup(), 1, {&looks, &scorer}), Outcome::arrived);
  const auto& ekf = scorer.score().localizers.at("ekf");
  EXPECT_GE(looks.landmarks.size(), 3U);
  EXPECT_GT(looks.planned, 0);
  EXPECT_EQ(scorer.score().perception.target_losses, 0);
  EXPECT_LT(ekf.position_rmse_m, 3.0 * ekf.pcrlb_position_rms_m);
  EXPECT_EQ(ekf.lost_s, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Rooms, PointsMission,
                         ::testing::Values("quixote-room", "tag-room", "mixed-room"),
                         [](const auto& test) {
                           std::string name = test.param;
                           name.erase(name.find('-'));
                           return name;
                         });

// The EKF, told of a third of the head's error, rejects patterns until their looks are dropped, in
// ticks in which pattern_fix takes them in.
TEST(PointsMissions, ADroppedLookIsToldWithTheObservationThatALocalizerTookIn) {
  const MissionSetup setup = load_mission(
      std::string(VIGIA_SOURCE_DIR) + "/config/missions/quixote-room.yaml",
      {"planner.policy=greedy", "timeout_s=37", "localization.ekf.sensor.look_angle_deg=0.1"});
  Updates updates;
  run_mission(setup, 1, {&updates});
  EXPECT_GT(updates.dropped, 0);
  EXPECT_GT(updates.count, 100);
  EXPECT_EQ(updates.untold, 0);
}

}  // namespace
}  // namespace vigia::mission
