#include "vigia/servo/zoom_control.hpp"

#include "head_bench.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace vigia::servo {
namespace {

TEST(ZoomControl, RestsInsideTheDeadBand) {
  ZoomControl control({1.5, 0.1});
  EXPECT_EQ(control.rate(test_zoom(), 20.0, 22.0, 24.0, -0.2), 0.0);
}

TEST(ZoomControl, FollowsTheLawOfSizeAndApproachOutsideIt) {
  ZoomControl control({1.5, 0.1});
  const double zoom_mm = 20.0;
  const double focal = test_zoom().at(zoom_mm).px;
  const double slope = 3500.0 / 40.0;  // px per mm of the calibration
  const double expected = focal * (1.5 * std::log(24.0 / 12.0) - 0.1) / slope;
  EXPECT_NEAR(control.rate(test_zoom(), zoom_mm, 12.0, 24.0, -0.1), expected, 1e-9);
}

TEST(ZoomControl, OnceMovingGoesOnWellIntoTheBandBeforeItRests) {
  ZoomControl control({1.5, 0.1});
  EXPECT_GT(control.rate(test_zoom(), 20.0, 20.0, 24.0, 0.0), 0.0);
  EXPECT_GT(control.rate(test_zoom(), 20.0, 22.5, 24.0, 0.0), 0.0);
  EXPECT_EQ(control.rate(test_zoom(), 20.0, 23.8, 24.0, 0.0), 0.0);
  EXPECT_EQ(control.rate(test_zoom(), 20.0, 22.5, 24.0, 0.0), 0.0);
}

TEST(ZoomControl, StopsAtTheEndsOfItsRange) {
  ZoomControl control({1.5, 0.1});
  EXPECT_EQ(control.rate(test_zoom(), 48.0, 10.0, 24.0, 0.0), 0.0);
  EXPECT_EQ(control.rate(test_zoom(), 8.0, 60.0, 24.0, 0.0), 0.0);
  EXPECT_LT(control.rate(test_zoom(), 48.0, 60.0, 24.0, 0.0), 0.0);
  EXPECT_GT(control.rate(test_zoom(), 8.0, 10.0, 24.0, 0.0), 0.0);
}

TEST(ZoomControl, LeavesALensAloneThatDoesNotZoom) {
  ZoomControl control({1.5, 0.1});
  const ZoomCalibration lens(640, 480, 319.5, 239.5, {{0.0, 900.0, 0.0}});
  EXPECT_EQ(control.rate(lens, 0.0, 10.0, 24.0, -0.5), 0.0);
}

TEST(ZoomControl, BringsADiscToItsWantedSizeWhileTheRobotApproaches) {
  const ZoomCalibration zoom = test_zoom();
  ZoomControl control({1.5, 0.05});
  double zoom_mm = 16.0;
  double depth = 5.0;
  double radius = 0.0;
  for (int tick = 0; tick < 200; ++tick) {
    radius = zoom.at(zoom_mm).px * 0.1 / depth;
    zoom_mm += 0.04 * control.rate(zoom, zoom_mm, radius, 40.0, -0.3 / depth);
    depth -= 0.3 * 0.04;
  }
  EXPECT_LT(std::abs(std::log(radius / 40.0)), 0.05);
}

}  // namespace
}  // namespace vigia::servo
