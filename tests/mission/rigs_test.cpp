#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

// Missions of robots that have other cameras than one with pan, tilt and zoom.

MissionSetup room(const std::string& robot, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"robot={name: other, " + robot + "}"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml",
                      overrides);
}

const std::string kPair =
    "cameras: [{mount: fixed, mount_m: [0.15, 0.1, 1.2], focal_px: 500}, "
    "{id: 4, mount: fixed, mount_m: [0.15, -0.1, 1.2], focal_px: 500, period_s: 0.2}]";
const std::string kPanTilt =
    "head: {mount_m: [0.1, 0, 1.2]}, cameras: [{focal_px: 900}], range_ring: {}";

class CameraLog : public Listener {
 public:
  void on_start(const MissionStart& start) override { eyes = start.eyes.size(); }
  void on_tick(const Tick& tick) override {
    attended = attended || tick.attention.has_value();
    for (const Observation& observation : tick.estimator.observations)
      ++seen_by[shot_of(observation).camera];
    largest_zoom_mm = std::max(largest_zoom_mm, tick.head.zoom_mm);
  }
  std::size_t eyes = 0;
  bool attended = false;
  std::map<CameraId, int> seen_by;
  double largest_zoom_mm = 0.0;
};

TEST(Rigs, ARobotWithoutAHeadLocalizesItselfByWhatPassesItsFixedCameras) {
  CameraLog looks;
  evaluation::DriveScorer scorer;
  run_mission(room(kPair, {"timeout_s=25"}), 3, {&looks, &scorer});
  EXPECT_EQ(looks.eyes, 2U);
  EXPECT_FALSE(looks.attended);
  EXPECT_GT(looks.seen_by[0], 100);
  EXPECT_GT(looks.seen_by[4], 20);
  EXPECT_LT(looks.seen_by[4], looks.seen_by[0] / 3);
  const auto& localizers = scorer.score().localizers;
  EXPECT_LT(localizers.at("ekf").position_rmse_m, 0.05);
  EXPECT_LT(localizers.at("ekf").position_final_m, localizers.at("odometry").position_final_m);
}

TEST(Rigs, AHeadDirectsACameraThatHasNoZoom) {
  CameraLog looks;
  evaluation::DriveScorer scorer;
  EXPECT_EQ(run_mission(room(kPanTilt), 3, {&looks, &scorer}), Outcome::arrived);
  EXPECT_TRUE(looks.attended);
  EXPECT_EQ(looks.largest_zoom_mm, 0.0);
  EXPECT_LT(scorer.score().localizers.at("ekf").position_rmse_m, 0.05);
}

TEST(Rigs, AnOmnidirectionalCameraIsRefusedWhereNoEyeReadsIt) {
  try {
    room("cameras: [{id: 5, mount: fixed, optics: omni, focal_px: 130}]");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("camera 5 is omnidirectional"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace vigia::mission
