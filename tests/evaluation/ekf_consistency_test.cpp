#include "localization/drive.hpp"

#include <gtest/gtest.h>

#include "vigia/evaluation/metrics.hpp"
#include "vigia/evaluation/pcrlb.hpp"
#include "vigia/localization/ekf.hpp"

namespace vigia::evaluation {
namespace {

using localization::EkfLocalizer;
using localization::EkfParams;
using localization::test::Drive;
using localization::test::DriveNoise;
using localization::test::DriveStep;

constexpr int kDriveRuns = 100;

EkfParams matched(const DriveNoise& noise) {
  EkfParams params;
  params.odometry = noise.odometry;
  params.sensor = noise.sensor;
  params.centre_floor_px = 0.0;
  params.size_floor = 0.0;
  return params;
}

/// What a run of the filter gives at the end of every look and before every look.
struct Run {
  std::vector<double> nees;
  double squared_error = 0.0;
  double bound = 0.0;
  DriveErrors errors;
  int fused = 0;
  int other = 0;
};

Run run_filter(const Drive& drive, const EkfParams& params) {
  const LandmarkMap map = localization::test::room_landmarks();
  EkfLocalizer ekf(map, {head_rig(drive.geometry), {}}, params, localization::test::room_plan());
  ekf.reset({}, drive.prior);
  PosteriorBound bound(drive.prior.covariance, {head_rig(drive.geometry), {}}, drive.noise.sensor);
  Run run;
  std::vector<PoseSample> samples;
  Pose2 before = drive.start;
  for (std::size_t i = 0; i < drive.steps.size(); ++i) {
    const DriveStep& step = drive.steps[i];
    ekf.predict(step.measured);
    bound.predict(before, step.truth, control_covariance(step.truth, drive.noise.odometry));
    if (step.seen) {
      const auto result = ekf.update(*step.seen);
      const bool fused = result.status == localization::UpdateStatus::fused;
      fused ? ++run.fused : ++run.other;
      bound.update(step.pose, step.bias, *map.find(*step.seen->expected), *step.seen);
    }
    before = step.pose;
    const PoseSample sample{step.pose, ekf.belief().pose, ekf.belief().covariance};
    samples.push_back(sample);
    run.squared_error += difference(sample.estimate, sample.truth).head<2>().squaredNorm();
    run.bound += bound.covariance().topLeftCorner<2, 2>().trace();
    const bool last_of_look =
        step.seen && (i + 1 == drive.steps.size() || !drive.steps[i + 1].seen);
    if (last_of_look) run.nees.push_back(nees(sample));
  }
  run.errors = drive_errors(samples);
  return run;
}

struct Campaign {
  Anees consistency;
  Estimate ratio;
  double rmse = 0.0;
  double final_position = 0.0;
  double final_heading = 0.0;
  int fused = 0;
  int other = 0;
};

template <typename Params>
Campaign run_campaign(const DriveNoise& noise, const Params& params) {
  Campaign campaign;
  std::vector<std::vector<double>> all;
  std::vector<double> errors;
  std::vector<double> bounds;
  for (int seed = 0; seed < kDriveRuns; ++seed) {
    const Run run = run_filter(simulate_drive(noise, static_cast<std::uint64_t>(seed)), params);
    all.push_back(run.nees);
    errors.push_back(run.squared_error);
    bounds.push_back(run.bound);
    campaign.rmse += run.errors.position_rmse / kDriveRuns;
    campaign.final_position += run.errors.position_final / kDriveRuns;
    campaign.final_heading += run.errors.heading_final / kDriveRuns;
    campaign.fused += run.fused;
    campaign.other += run.other;
  }
  campaign.consistency = anees(all, 3);
  campaign.ratio = pcrlb_ratio(errors, bounds, 1);
  return campaign;
}

/// DESIGN's statistics: ANEES in its band at nine look instants of ten and 0.9–1.1 on average; at
/// most 1.10 of the bound.
void expect_consistent(const Campaign& campaign) {
  EXPECT_GE(campaign.consistency.inside_band, 0.9);
  EXPECT_GT(campaign.consistency.mean_per_dof, 0.9);
  EXPECT_LT(campaign.consistency.mean_per_dof, 1.1);
  EXPECT_LE(campaign.ratio.value, 1.10);
  EXPECT_GT(campaign.ratio.interval.high, 1.0);       // nobody beats the bound
  EXPECT_LT(campaign.other, 0.003 * campaign.fused);  // the gate passes 99.9 %
}

TEST(EkfConsistency, IsConsistentAndAtTheBoundWhenTheErrorIsConstantDuringALook) {
  const DriveNoise noise;
  const Campaign campaign = run_campaign(noise, matched(noise));
  expect_consistent(campaign);
  EXPECT_LT(campaign.final_position, 0.02);
  EXPECT_LT(campaign.final_heading, from_deg(0.5));
  EXPECT_LT(campaign.rmse, 0.045);
}

TEST(EkfConsistency, IsConsistentAndAtTheBoundWithBothPartsOfTheReadingError) {
  DriveNoise noise;
  noise.sensor.reading_angle = from_deg(0.1);
  expect_consistent(run_campaign(noise, matched(noise)));
}

// 5 mm of error on the 12 mm of a tick.
TEST(EkfConsistency, StaysConsistentWhenHalfOfAnIncrementIsNoise) {
  DriveNoise noise;
  noise.odometry.trans_per_sqrt_m = 0.05;
  expect_consistent(run_campaign(noise, matched(noise)));
}

TEST(EkfConsistency, StaysConsistentWithTheDefaultFloors) {
  const DriveNoise noise;
  EkfParams params = matched(noise);
  params.centre_floor_px = EkfParams{}.centre_floor_px;
  params.size_floor = EkfParams{}.size_floor;
  expect_consistent(run_campaign(noise, params));
}

TEST(EkfConsistency, StaysConsistentWithoutTheDiscsSize) {
  const DriveNoise noise;
  EkfParams pan_tilt = matched(noise);
  pan_tilt.use_size = false;
  const Campaign campaign = run_campaign(noise, pan_tilt);
  // Of eighteen looks more than three outside a 95 % band come by chance with a probability of 1 %.
  EXPECT_GE(campaign.consistency.inside_band, 15.0 / 18.0);
  EXPECT_GT(campaign.consistency.mean_per_dof, 0.9);
  EXPECT_LT(campaign.consistency.mean_per_dof, 1.1);
  EXPECT_LT(campaign.other, 0.003 * campaign.fused);
  EXPECT_GT(campaign.ratio.interval.low, 1.0);  // the bound knows the size
}

TEST(EkfConsistency, TakingTheErrorOfALookForWhiteNoiseMakesTheFilterOverConfident) {
  const DriveNoise noise;
  EkfParams naive = matched(noise);
  naive.sensor.look_angle = 1e-6;
  naive.sensor.reading_angle = noise.sensor.look_angle;
  naive.sensor.look_focal = 1e-6;
  naive.size_floor = noise.sensor.look_focal;
  const Campaign campaign = run_campaign(noise, naive);
  EXPECT_GT(campaign.consistency.mean_per_dof, 2.0);
  EXPECT_LT(campaign.consistency.inside_band, 0.1);
}

}  // namespace
}  // namespace vigia::evaluation
