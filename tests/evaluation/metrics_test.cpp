#include "vigia/evaluation/metrics.hpp"

#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "vigia/core/random.hpp"

namespace vigia::evaluation {
namespace {

PoseSample sample(double dx, double dy, double dtheta) {
  PoseSample s;
  s.truth = {1.0, 2.0, kPi - 0.001};
  s.estimate = {1.0 + dx, 2.0 + dy, wrap_angle(s.truth.theta + dtheta)};
  s.covariance = Eigen::Vector3d(0.01, 0.04, 0.0001).asDiagonal();
  return s;
}

TEST(Metrics, ErrorsOfADriveAreFinalRmsAndMaximum) {
  const DriveErrors errors = drive_errors({sample(0.3, 0.4, 0.01), sample(0.0, 0.1, -0.02)});
  EXPECT_NEAR(errors.position_final, 0.1, 1e-12);
  EXPECT_NEAR(errors.position_max, 0.5, 1e-12);
  EXPECT_NEAR(errors.position_rmse, std::sqrt((0.25 + 0.01) / 2.0), 1e-12);
  EXPECT_NEAR(errors.heading_final, 0.02, 1e-12);
  EXPECT_NEAR(errors.heading_max, 0.02, 1e-12);
  EXPECT_NEAR(errors.heading_rmse, std::sqrt((1e-4 + 4e-4) / 2.0), 1e-12);
  EXPECT_NEAR(errors.nees_mean, 0.5 * ((9.0 + 4.0 + 1.0) + (0.25 + 4.0)), 1e-9);
}

TEST(Metrics, MeanLengthOfAGaussianErrorIsRayleighsWhenRoundAndFoldedWhenFlat) {
  const Eigen::Matrix2d flat = Eigen::Vector2d(4.0, 0.0).asDiagonal();
  EXPECT_NEAR(mean_length(0.25 * Eigen::Matrix2d::Identity()), 0.5 * std::sqrt(kPi / 2.0), 1e-12);
  EXPECT_NEAR(mean_length(flat), 2.0 * std::sqrt(2.0 / kPi), 1e-12);
  EXPECT_EQ(mean_length(Eigen::Matrix2d::Zero()), 0.0);
}

TEST(Metrics, MeanLengthIsThatOfASample) {
  constexpr int kDraws = 200000;
  Eigen::Matrix2d covariance;
  covariance << 2.0, 0.6, 0.6, 0.5;
  const Eigen::Matrix2d root = covariance.llt().matrixL();
  RandomStream random(3, "length");
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i)
    sum += (root * Eigen::Vector2d(random.normal(), random.normal())).norm();
  const double mean = mean_length(covariance);
  const double sigma = std::sqrt((covariance.trace() - mean * mean) / kDraws);
  EXPECT_NEAR(sum / kDraws, mean, 4.0 * sigma);  // k = 4
}

TEST(Metrics, ADriveWithoutSamplesIsAnError) {
  EXPECT_THROW(drive_errors({}), std::invalid_argument);
}

TEST(Metrics, AneesBandsAreThePublishedOnes) {
  // PAPERS, 95 %, 3 degrees of freedom.
  const struct {
    int runs;
    double low;
    double high;
  } bands[] = {{20, 0.675, 1.388}, {50, 0.787, 1.239}, {100, 0.846, 1.166}, {500, 0.930, 1.073}};
  for (const auto& expected : bands) {
    const Interval band = anees_band(expected.runs, 3);
    EXPECT_NEAR(band.low, expected.low, 5e-4);
    EXPECT_NEAR(band.high, expected.high, 5e-4);
  }
}

TEST(Metrics, AneesOfAConsistentEstimatorLiesInItsBandAtNineteenInstantsOfTwenty) {
  constexpr int kRuns = 50;
  constexpr int kInstants = 2000;
  RandomStream random(1, "anees");
  std::vector<std::vector<double>> all(kRuns, std::vector<double>(kInstants));
  for (auto& run : all)
    for (double& value : run)
      for (int d = 0; d < 3; ++d) value += std::pow(random.normal(), 2);
  const Anees result = anees(all, 3);
  EXPECT_NEAR(result.inside_band, 0.95, 4.0 * std::sqrt(0.95 * 0.05 / kInstants));  // k = 4
  EXPECT_NEAR(result.mean_per_dof, 1.0, 4.0 * std::sqrt(2.0 / (3.0 * kRuns * kInstants)));
}

TEST(Metrics, AneesNeedsTheSameInstantsInEveryRun) {
  EXPECT_THROW(anees({}, 3), std::invalid_argument);
  EXPECT_THROW(anees({{1.0, 2.0}, {1.0}}, 3), std::invalid_argument);
}

TEST(Metrics, PcrlbRatioIsTheRootOfTheSumsRatio) {
  const Estimate ratio = pcrlb_ratio({4.0, 5.0}, {1.0, 3.0}, 1);
  EXPECT_NEAR(ratio.value, 1.5, 1e-12);
  EXPECT_GE(ratio.interval.low, std::sqrt(5.0 / 3.0) - 1e-12);
  EXPECT_LE(ratio.interval.high, 2.0 + 1e-12);
  EXPECT_THROW(pcrlb_ratio({1.0}, {}, 1), std::invalid_argument);
}

TEST(Metrics, BootstrapIntervalHoldsTheTruthAboutNineteenTimesOfTwenty) {
  constexpr int kTrials = 400;
  constexpr int kRuns = 60;
  RandomStream random(2, "bootstrap");
  int held = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> errors(kRuns);
    for (double& e : errors)
      for (int d = 0; d < 6; ++d) e += std::pow(random.normal(), 2) / 6.0;
    const Estimate ratio = pcrlb_ratio(errors, std::vector<double>(kRuns, 1.0),
                                       static_cast<std::uint64_t>(trial), 500);
    held += ratio.interval.contains(1.0) ? 1 : 0;
  }
  // The percentile bootstrap falls short by about 1/√runs of its tails at most: 0.92 to 0.97.
  EXPECT_GT(held, (0.92 - 4.0 * std::sqrt(0.92 * 0.08 / kTrials)) * kTrials);  // k = 4
  EXPECT_LT(held, (0.97 + 4.0 * std::sqrt(0.97 * 0.03 / kTrials)) * kTrials);
}

TEST(Metrics, BootstrapIsTheSameForTheSameSeed) {
  const std::vector<double> errors{1.0, 2.0, 3.0, 0.5};
  const std::vector<double> bounds{1.0, 1.5, 2.0, 1.0};
  EXPECT_EQ(pcrlb_ratio(errors, bounds, 5).interval.low,
            pcrlb_ratio(errors, bounds, 5).interval.low);
}

TEST(Metrics, ClopperPearsonGivesTheTabulatedIntervals) {
  // All and none: 1 − 0.025^(1/n) in closed form.
  const double tail = 1.0 - std::pow(0.025, 1.0 / 100.0);
  EXPECT_NEAR(clopper_pearson(0, 100).high, tail, 1e-12);
  EXPECT_EQ(clopper_pearson(0, 100).low, 0.0);
  EXPECT_NEAR(clopper_pearson(100, 100).low, 1.0 - tail, 1e-12);
  EXPECT_EQ(clopper_pearson(100, 100).high, 1.0);
  // 5 of 10: 0.187 to 0.813.
  EXPECT_NEAR(clopper_pearson(5, 10).low, 0.1871, 1e-4);
  EXPECT_NEAR(clopper_pearson(5, 10).high, 0.8129, 1e-4);
}

TEST(Metrics, APoissonMeanHasTheTabulatedInterval) {
  // None: 0 to −ln 0.025.
  EXPECT_EQ(poisson_mean(0).low, 0.0);
  EXPECT_NEAR(poisson_mean(0).high, -std::log(0.025), 1e-12);
  // 10: 4.795 to 18.390.
  EXPECT_NEAR(poisson_mean(10).low, 4.795, 1e-3);
  EXPECT_NEAR(poisson_mean(10).high, 18.390, 1e-3);
}

TEST(Metrics, PairedDifferenceUsesThePairs) {
  // Differences 1, 2, 3: mean 2, standard error 1/√3, t(2 dof, 97.5 %) = 4.3027.
  const Estimate d = paired_difference({11.0, 22.0, 33.0}, {10.0, 20.0, 30.0});
  EXPECT_NEAR(d.value, 2.0, 1e-12);
  EXPECT_NEAR(d.interval.high - d.value, 4.3027 / std::sqrt(3.0), 1e-4);
  EXPECT_THROW(paired_difference({1.0}, {2.0}), std::invalid_argument);
}

}  // namespace
}  // namespace vigia::evaluation
