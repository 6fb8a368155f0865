#include "look_around.hpp"

#include <gtest/gtest.h>

#include "vigia/mission/mission.hpp"

namespace vigia::mission {
namespace {

/// The head where the rates of the sweep have taken it after a second.
HeadReading after_a_second(const LookAround& sweep, HeadReading head, double tick_s) {
  for (double t = 0.0; t < 1.0; t += tick_s) head.zoom_mm += tick_s * sweep.step(head).zoom_mm_s;
  return head;
}

TEST(LookAround, FromAPlaceThatItCouldNotLeaveItLooksFartherNextTime) {
  const MissionSetup setup =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/quixote-room.yaml", {});
  const double wide_mm = setup.robot.zoom().min_zoom_mm();
  LookAround sweep(setup);
  HeadReading head;
  head.zoom_mm = wide_mm;
  const auto lens_of_next = [&](bool again) {
    sweep.begin(head, again);
    head = after_a_second(sweep, head, setup.tick_s);
    return head.zoom_mm / wide_mm;
  };
  EXPECT_NEAR(lens_of_next(false), 1.0, 1e-9);
  EXPECT_NEAR(lens_of_next(true), 1.5, 1e-9);
  EXPECT_NEAR(lens_of_next(true), 2.25, 1e-9);
  EXPECT_NEAR(lens_of_next(true), 1.0, 1e-9);
  EXPECT_NEAR(lens_of_next(true), 1.5, 1e-9);
  EXPECT_NEAR(lens_of_next(false), 1.0, 1e-9);
}

}  // namespace
}  // namespace vigia::mission
