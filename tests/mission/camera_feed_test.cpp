#include "camera_feed.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/mission/delays.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::mission {
namespace {

using ::testing::ElementsAre;

/// When a camera's frames were exposed, and when they arrived, in milliseconds, over some ticks of
/// 40 ms.
struct Deliveries {
  std::vector<std::int64_t> exposed_ms;
  std::vector<std::int64_t> arrived_ms;
};

Deliveries deliveries_of(const Camera& camera, Duration delay, int ticks,
                         Duration processing = {}) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml");
  sim::Simulator simulator(setup.robot, setup.world, setup.appearance, setup.start, 1);
  CameraFeed feed(camera, delay, processing, nullptr);
  Deliveries result;
  for (int i = 1; i <= ticks; ++i) {
    const Stamp now{i * 40'000'000LL};
    simulator.advance(Duration{40'000'000});
    Shot shot;
    shot.stamp = now;
    feed.expose(simulator, shot);
    const auto exposure = feed.take(now);
    if (!exposure) continue;
    result.exposed_ms.push_back(exposure->shot.stamp.ns / 1'000'000);
    result.arrived_ms.push_back(now.ns / 1'000'000);
  }
  return result;
}

TEST(CameraFeed, WithoutAPeriodDeliversInEveryTick) {
  EXPECT_THAT(deliveries_of(Camera{}, {}, 3).exposed_ms, ElementsAre(40, 80, 120));
}

TEST(CameraFeed, ExposesInTheFirstTickAfterEachOfItsInstants) {
  Camera camera;
  camera.period_s = 0.1;
  camera.phase_s = 0.06;  // 60, 160, 260, 360 ms
  EXPECT_THAT(deliveries_of(camera, {}, 10).exposed_ms, ElementsAre(80, 160, 280, 360));
}

TEST(CameraFeed, DeliversLateByItsLatencyAndTheDelay) {
  Camera camera;
  camera.latency_s = 0.05;
  const Deliveries late = deliveries_of(camera, Duration{20'000'000}, 4);
  EXPECT_THAT(late.exposed_ms, ElementsAre(40, 80));
  EXPECT_THAT(late.arrived_ms, ElementsAre(120, 160));
}

TEST(CameraFeed, AFrameThatTakesLongToProcessIsLateAndMakesItDropThoseThatArriveMeanwhile) {
  Camera camera;
  camera.latency_s = 0.04;
  const Deliveries slow = deliveries_of(camera, {}, 9, Duration{100'000'000});
  EXPECT_THAT(slow.exposed_ms, ElementsAre(40, 160));
  EXPECT_THAT(slow.arrived_ms, ElementsAre(200, 320));
}

TEST(CameraFeed, ProcessingFasterThanFramesArriveDropsNone) {
  const Deliveries quick = deliveries_of(Camera{}, {}, 4, Duration{30'000'000});
  EXPECT_THAT(quick.exposed_ms, ElementsAre(40, 80, 120));
  EXPECT_THAT(quick.arrived_ms, ElementsAre(80, 120, 160));
}

TEST(CameraFeed, LongestDelayIsThatOfTheLatestImage) {
  MissionSetup setup;
  for (const double latency_s : {0.0, 0.05})
    for (const double period_s : {0.0, 0.1, 0.24, 0.4})
      for (const double processing_s : {0.0, 0.03, 0.1, 0.28}) {
        Camera camera;
        camera.period_s = period_s;
        camera.latency_s = latency_s;
        setup.disturbances.latency = sim::LatencyParams{0.02, processing_s};
        const Deliveries all = deliveries_of(camera, Duration::from_seconds(0.02), 100,
                                             Duration::from_seconds(processing_s));
        std::int64_t latest_ms = 0;
        for (std::size_t i = 0; i < all.exposed_ms.size(); ++i)
          latest_ms = std::max(latest_ms, all.arrived_ms[i] - all.exposed_ms[i]);
        EXPECT_EQ(longest_delay(setup, camera).ns, latest_ms * 1'000'000)
            << latency_s << ' ' << period_s << ' ' << processing_s;
      }
}

}  // namespace
}  // namespace vigia::mission
