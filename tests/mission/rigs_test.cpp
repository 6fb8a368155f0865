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

class EventCounts : public Listener {
 public:
  void on_event(const Event& event) override { ++of[event.kind]; }
  std::map<EventKind, int> of;
};

TEST(Rigs, AHeadWaitsForTheImagesOfASlowCamera) {
  for (const std::string timing :
       {"period_s: 0.5", "period_s: 1", "period_s: 0.5, latency_s: 0.4"}) {
    EventCounts events;
    evaluation::DriveScorer scorer;
    run_mission(room("head: {mount_m: [0.1, 0, 1.2]}, cameras: [{focal_px: 900, " + timing + "}]",
                     {"timeout_s=40"}),
                3, {&events, &scorer});
    EXPECT_GE(events.of[EventKind::acquired], 3) << timing;
    EXPECT_EQ(events.of[EventKind::target_lost], 0) << timing;
    // The drive may end in the middle of the last one.
    EXPECT_GE(events.of[EventKind::released], events.of[EventKind::acquired] - 1) << timing;
    EXPECT_EQ(events.of[EventKind::stop], 0) << timing;
    EXPECT_LT(scorer.score().localizers.at("ekf").position_rmse_m, 0.05) << timing;
  }
}

class LossLog : public Listener {
 public:
  void on_start(const MissionStart& start) override { names_ = start.setup.localizers; }
  void on_tick(const Tick& tick) override {
    if (kidnapped_s == 0.0) return;
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (tick.estimator.localizers[i].belief->status == BeliefStatus::lost)
        said_s.try_emplace(names_[i], tick.estimator.now.seconds());
  }
  void on_event(const Event& event) override {
    if (event.kind == EventKind::kidnapped) kidnapped_s = event.stamp.seconds();
    if (event.kind == EventKind::lost && kidnapped_s == 0.0) ++false_alarms;
  }
  double kidnapped_s = 0.0;
  int false_alarms = 0;
  std::map<std::string, double> said_s;

 private:
  std::vector<std::string> names_;
};

MissionSetup tag_room(const std::string& cameras, const std::vector<std::string>& more) {
  std::vector<std::string> overrides{"robot={name: other, " + cameras + "}"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/tag-room.yaml", overrides);
}

const std::string kThreeFixed = [] {
  const std::string optics = "focal_px: 250, width_px: 320, height_px: 240, period_s: 0.2}";
  return "{id: 4, mount: fixed, mount_m: [0.1, 0, 1.2], " + optics +
         ", {id: 5, mount: fixed, mount_m: [0, 0.1, 1.2], rpy_deg: [0, 0, 120], " + optics +
         ", {id: 6, mount: fixed, mount_m: [0, -0.1, 1.2], rpy_deg: [0, 0, 240], " + optics;
}();

// No look of a fixed camera ever ends; what contradicts the belief counts by the second.
TEST(Rigs, ARobotOfFixedCamerasSaysThatItIsLostOnceItWasTakenAway) {
  for (const std::uint64_t seed : {3, 4}) {
    LossLog log;
    run_mission(tag_room("cameras: [" + kThreeFixed + "]",
                         {"timeout_s=24", "disturbances.kidnapping={earliest_s: 10, latest_s: 12}",
                          "localization.localizers=[ekf, bearing_only]"}),
                seed, {&log});
    ASSERT_GT(log.kidnapped_s, 0.0);
    EXPECT_EQ(log.false_alarms, 0);
    for (const char* name : {"ekf", "bearing_only"}) {
      ASSERT_EQ(log.said_s.count(name), 1U) << name << ", seed " << seed;
      EXPECT_LT(log.said_s[name], log.kidnapped_s + 4.0) << name << ", seed " << seed;
    }
  }
}

TEST(Rigs, TheBoundOfWhatLandmarksTellIsThatWithoutACeilingToo) {
  const std::string cameras =
      "cameras: [{mount: fixed, mount_m: [0.15, 0, 1.2], focal_px: 250, width_px: 320, height_px: "
      "240, "
      "period_s: 0.2}, {id: 2, mount: fixed, mount_m: [0, 0, 0.7], rpy_deg: [0, -90, 0], focal_px: "
      "300, "
      "width_px: 320, height_px: 240, period_s: 0.2}]";
  double bound_m[2];
  for (const bool ceiling : {false, true}) {
    std::vector<std::string> more{"timeout_s=15", "localization.localizers=[ekf]"};
    if (ceiling)
      more = {"timeout_s=15", "localization.localizers=[ekf, ceiling]", "world.ceiling={}"};
    evaluation::DriveScorer scorer;
    run_mission(tag_room(cameras, more), 3, {&scorer});
    bound_m[ceiling ? 1 : 0] = scorer.score().localizers.at("ekf").pcrlb_position_rms_m;
  }
  EXPECT_NEAR(bound_m[1] / bound_m[0], 1.0, 0.1);
}

TEST(Rigs, WhatNoLocalizerCanUseIsRefused) {
  const std::string ceiling = std::string(VIGIA_SOURCE_DIR) + "/config/missions/ceiling-hall.yaml";
  EXPECT_THROW(
      load_mission(ceiling, {"robot={name: other, cameras: [{mount: fixed, mount_m: [0, 0, 0.5], "
                             "rpy_deg: [0, -90, 0]}, {id: 2, mount: fixed, mount_m: [0.3, 0, 0.5], "
                             "rpy_deg: [0, -90, 0]}]}"}),
      InputError);
}

TEST(Rigs, ACameraAboveTheRoomsCeilingIsRefused) {
  const auto refused = [](const std::string& robot) {
    try {
      room(robot);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string fixed = "cameras: [{id: 5, mount: fixed, focal_px: 400, mount_m: [0, 0, ";
  EXPECT_EQ(refused(fixed + "2.7]}]"), "");
  const std::string above = refused(fixed + "5]}]");
  EXPECT_NE(above.find("camera 5 is 5 m above the floor"), std::string::npos) << above;
  EXPECT_NE(above.find("room.height_m 2.8"), std::string::npos) << above;
  EXPECT_NE(refused("head: {mount_m: [0, 0, 3]}, cameras: [{focal_px: 400}]").find("3 m above"),
            std::string::npos);
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
