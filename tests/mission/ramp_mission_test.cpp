#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

class RampEvents : public Listener {
 public:
  void on_tick(const Tick& tick) override {
    const Eigen::Isometry3d& wMr = *tick.estimator.truth->wMr;
    highest_m = std::max(highest_m, wMr.translation().z());
    steepest = std::max(steepest, std::asin(wMr.linear()(2, 0)));
    downward = std::min(downward, std::asin(wMr.linear()(2, 0)));
  }
  void on_event(const Event& event) override {
    if (event.kind == EventKind::ground_off) off.push_back(event.numbers);
  }
  double highest_m = 0.0;
  double steepest = 0.0;
  double downward = 0.0;
  std::vector<Event::Numbers> off;
};

MissionSetup ramp_gallery(const std::vector<std::string>& overrides = {}) {
  return load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/ramp-gallery.yaml",
                      overrides);
}

// Seed 2: bounds of the issue, 3 cm and 1°, for the worst of its 60 looks; over seeds 1–20 the
// worst of 1131 is 1.6 cm and 0.97° (a roll).
TEST(RampMission, PatternsAloneGiveHeightAndPitchOnTheRampAndTheEkfKnowsTheGround) {
  RampEvents events;
  evaluation::DriveScorer scorer;
  EXPECT_EQ(run_mission(ramp_gallery(), 2, {&events, &scorer}), Outcome::arrived);
  const double slope = std::atan(0.08);
  EXPECT_NEAR(events.highest_m, 10.0 * std::sin(slope), 1e-9);
  EXPECT_NEAR(events.steepest, slope, 1e-9);
  EXPECT_NEAR(events.downward, -slope, 1e-9);
  const auto& fix = scorer.score().localizers.at("pattern_fix");
  EXPECT_GT(fix.in_space->ramps.looks, 15);
  EXPECT_LT(fix.in_space->ramps.z_max_m, 0.03);
  EXPECT_LT(fix.in_space->ramps.pitch_max_rad, from_deg(1.0));
  const auto& ekf = scorer.score().localizers.at("ekf");
  EXPECT_LT(ekf.in_space->ramps.z_max_m, 0.003);
  EXPECT_LT(ekf.position_rmse_m, 1.5 * ekf.pcrlb_position_rms_m);
  EXPECT_LT(ekf.nees_mean, 6.0);
  EXPECT_TRUE(events.off.empty());
}

TEST(RampMission, ARampThatTheMapHasWrongIsTold) {
  RampEvents events;
  run_mission(ramp_gallery({"disturbances.ramp_error=realistic", "localization.primary=pattern_fix",
                            "timeout_s=60"}),
              1, {&events});
  ASSERT_FALSE(events.off.empty());
  for (const auto& [name, value] : events.off[0]) {
    if (name == "piece") {
      EXPECT_EQ(value, 2.0);
    } else if (name == "steeper_deg") {
      EXPECT_NEAR(value, 1.0, 0.5);
    }
  }
}

}  // namespace
}  // namespace vigia::mission
