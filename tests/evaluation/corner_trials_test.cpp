#include "vigia/evaluation/corner_trials.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace vigia::evaluation {
namespace {

CornerSetting vga(CornerSetting::Columns columns) {
  CornerSetting setting;
  setting.columns = 640;
  setting.image = columns;
  return setting;
}

TEST(CornerRun, BothPointsLieInTheFieldAndShowTheSameCornerInBothImages) {
  const CornerSetting setting;
  RandomStream random(1, "run");
  for (int i = 0; i < 200; ++i) {
    const CornerRun run = draw_corner_run(setting, 2, true, random);
    ASSERT_EQ(run.truths.size(), 2U);
    EXPECT_EQ(run.exact.sightings[0].landmark, run.exact.sightings[1].landmark);
    for (const Pose2& truth : run.truths) {
      EXPECT_TRUE(truth.x > 0.0 && truth.x < 1.5 && std::abs(truth.y) < 0.65);
    }
    for (const auto& seen : run.measured.sightings)
      for (const double column : {seen.columns.left, seen.columns.right}) {
        EXPECT_TRUE(column >= 0.0 && column <= 319.0);
        EXPECT_EQ(column, std::round(column));
      }
  }
}

TEST(CornerRun, TheTrueColumnsAreThoseThatTheLocalizersModelPredicts) {
  CornerSetting setting;
  setting.calibration = {0.03, 0.01, -0.02};
  RandomStream random(2, "run");
  for (int i = 0; i < 50; ++i) {
    const CornerRun run = draw_corner_run(setting, 2, true, random);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& seen = run.exact.sightings[k];
      const Eigen::Vector2d p_r = (to_isometry(run.truths[k]).inverse() *
                                   Eigen::Vector3d(run.exact.landmarks[seen.landmark].p_w.x(),
                                                   run.exact.landmarks[seen.landmark].p_w.y(), 0.0))
                                      .head<2>();
      const auto predicted = localization::stereo_image(run.exact.pair, run.errors, p_r);
      EXPECT_LT((predicted->columns - seen.columns.vector()).norm(), 1e-9);
    }
  }
}

TEST(CornerTrials, AsPublishedTheRangeErrorIsThatOfRoundedColumns) {
  // An independent calculation at 60° has 3.3 % and 1.7 %.
  for (const auto& [columns, share] : {std::pair{320, 0.033}, std::pair{640, 0.017}}) {
    CornerSetting setting;
    setting.columns = columns;
    std::vector<double> shares;
    for (const CornerTrial& trial : study_corner_trials(setting, 5, 500, 1))
      for (std::size_t k = 0; k < 2; ++k)
        shares.push_back(trial.range_errors_m[k] / trial.ranges_m[k]);
    EXPECT_NEAR(spread_of(shares).mean, share, 0.15 * share);
  }
}

TEST(CornerTrials, RangeAndBearingTogetherReachTheirBoundAboveTheGate) {
  const auto trials = study_corner_trials(vga(CornerSetting::Columns::noisy), 6, 1000, 1);
  const BoundRatio judged = likeliest_ratio(trials, false);
  EXPECT_GT(judged.n, 500);
  EXPECT_LT(judged.ratio.value, 1.1);
  EXPECT_GT(judged.ratio.value, 0.9);
  EXPECT_GT(judged.nees, 0.8);
  EXPECT_LT(judged.nees, 1.2);
  EXPECT_LT(likeliest_ratio(trials, true).mean_m, 0.007);
}

TEST(CornerTrials, AStrangerToTheCalibrationIsFartherOffAndClaimsTooMuch) {
  CornerSetting setting = vga(CornerSetting::Columns::noisy);
  setting.calibration.baseline = 1.0 / 1.05 - 1.0;
  const BoundRatio biased = likeliest_ratio(study_corner_trials(setting, 6, 300, 1), false);
  EXPECT_GT(biased.nees, 5.0);
  EXPECT_GT(biased.ratio.value, 2.0);
}

TEST(CornerDrives, CarriedAsStatesTheErrorsOfCalibrationReachTheirBound) {
  CornerSetting setting = vga(CornerSetting::Columns::noisy);
  setting.calibration_sigma = {0.01, from_deg(0.1), 0.005};
  const auto drives = study_corner_drives(setting, 10, 7, 200, 1);
  const BoundRatio judged = drive_ratio(drives);
  EXPECT_EQ(judged.n, 200);
  EXPECT_LT(judged.ratio.value, 1.15);
  double uncorrected = 0.0;
  for (const CornerDrive& drive : drives) uncorrected += drive.uncorrected->head<2>().norm() / 200;
  EXPECT_GT(uncorrected, 2.0 * judged.mean_m);
}

TEST(CornerTrials, TheSameSeedHasTheSameTrialsOnAnyNumberOfThreads) {
  const CornerSetting setting;
  const auto one = study_corner_trials(setting, 9, 20, 1);
  const auto two = study_corner_trials(setting, 9, 20, 2);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].range_errors_m, two[i].range_errors_m);
    EXPECT_EQ(one[i].published.has_value(), two[i].published.has_value());
    EXPECT_EQ(*one[i].likeliest, *two[i].likeliest);
  }
}

TEST(CornerRun, ADisplacementThatTheFieldHasNoRoomForIsRefused) {
  CornerSetting setting;
  setting.displacement_m = 1.0;
  RandomStream random(1, "run");
  EXPECT_THROW(draw_corner_run(setting, 2, true, random), std::invalid_argument);
}

TEST(ErrorSpread, IsThatOfAbsoluteValues) {
  const ErrorSpread spread = spread_of({-3.0, 1.0, 2.0});
  EXPECT_EQ(spread.n, 3);
  EXPECT_DOUBLE_EQ(spread.mean, 2.0);
  EXPECT_NEAR(spread.deviation, std::sqrt(2.0 / 3.0), 1e-12);
  EXPECT_EQ(spread.least, 1.0);
  EXPECT_EQ(spread.greatest, 3.0);
}

}  // namespace
}  // namespace vigia::evaluation
