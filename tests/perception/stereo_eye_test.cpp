#include "perception/stereo_drive.hpp"

#include <gtest/gtest.h>

namespace vigia::perception {
namespace {

TEST(StereoEye, LetsTheRobotKnowItsPlaceByTheGoalsCorners) {
  StereoDrive drive;
  drive.disturbances.stereo = sim::StereoParams{};
  drive.calibration_sigma = {0.01, from_deg(0.1), 0.005};
  drive.duration_s = 20.0;
  const StereoScore score = drive.run(3);
  EXPECT_GT(score.corners, 30);
  EXPECT_EQ(score.wrong, 0);
  EXPECT_EQ(score.lost, 0);
  EXPECT_LT(std::sqrt(score.square_px / score.corners), 0.1);
  EXPECT_LT(std::sqrt(score.square_m2 / score.images), 0.02);
  EXPECT_LT(score.square_m2, 9.0 * score.bound_m2);
}

TEST(StereoEye, ErrorsOfTheCalibrationThatNobodyKnowsOfCostIt) {
  StereoDrive drive;
  drive.disturbances.stereo = sim::StereoParams{0.1, 0.0, 0.0};
  drive.duration_s = 20.0;
  const StereoScore blind = drive.run(3);
  drive.calibration_sigma = {0.1, 0.0, 0.0};
  const StereoScore aware = drive.run(3);
  EXPECT_LT(aware.square_m2, 0.5 * blind.square_m2);
}

}  // namespace
}  // namespace vigia::perception
