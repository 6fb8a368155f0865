#include "vigia/localization/mean_speed.hpp"

#include <gtest/gtest.h>

namespace vigia::localization {
namespace {

constexpr double kStep = 0.04;  // s
const OdometryNoise kRough{0.05, 0.015, 0.005};

OdometryIncrement straight_step(int tick, double v) {
  return arc_increment(v, 0.0, Stamp::from_seconds(kStep * tick),
                       Stamp::from_seconds(kStep * (tick + 1)));
}

TEST(MeanSpeed, AReadingOfNextToNothingInADriveWentAsFarAsTheOthers) {
  MeanSpeed speed(kRough);
  for (int tick = 0; tick < 40; ++tick) speed.at_mean_speed(straight_step(tick, 0.3));
  EXPECT_NEAR(speed.at_mean_speed(straight_step(40, 0.001)).trans, 0.3 * kStep, 0.1 * 0.3 * kStep);
}

TEST(MeanSpeed, AReadingThatTellsItsDistanceIsTakenAtItsWord) {
  MeanSpeed speed({0.002, 0.015, 0.005});
  for (int tick = 0; tick < 40; ++tick) speed.at_mean_speed(straight_step(tick, 0.3));
  EXPECT_DOUBLE_EQ(speed.at_mean_speed(straight_step(40, 0.2)).trans, 0.2 * kStep);
}

TEST(MeanSpeed, AReadingOfExactlyNothingIsThatOfABaseThatStands) {
  MeanSpeed speed(kRough);
  for (int tick = 0; tick < 40; ++tick) speed.at_mean_speed(straight_step(tick, 0.3));
  EXPECT_EQ(speed.at_mean_speed(straight_step(40, 0.0)).trans, 0.0);
}

TEST(MeanSpeed, BackwardMotionStaysBackward) {
  MeanSpeed speed(kRough);
  for (int tick = 0; tick < 40; ++tick) speed.at_mean_speed(straight_step(tick, -0.3));
  EXPECT_NEAR(speed.at_mean_speed(straight_step(40, -0.3)).trans, -0.3 * kStep, 1e-12);
}

}  // namespace
}  // namespace vigia::localization
