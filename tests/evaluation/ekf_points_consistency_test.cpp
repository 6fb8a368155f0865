#include "localization/points_drive.hpp"

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

constexpr int kPointsRuns = 60;

/// Pattern and tag looks along the drive of the discs' consistency test.
struct PointsCampaign {
  std::vector<std::vector<double>> nees;
  std::vector<double> errors;
  std::vector<double> bounds;
  int fused = 0;
  int other = 0;
};

void run(const DriveNoise& noise, std::uint64_t seed, PointsCampaign& campaign) {
  const Drive drive = localization::test::simulate_drive(noise, seed);
  const auto seen = localization::test::points_of(drive, seed);
  const LandmarkMap map = localization::test::room_points();
  EkfParams params;
  params.odometry = noise.odometry;
  params.sensor = noise.sensor;
  params.centre_floor_px = 0.0;
  EkfLocalizer ekf(map, {head_rig(drive.geometry), {}}, params, localization::test::room_plan());
  ekf.reset({}, drive.prior);
  PosteriorBound bound(drive.prior.covariance, {head_rig(drive.geometry), {}}, noise.sensor);
  campaign.nees.emplace_back();
  campaign.errors.push_back(0.0);
  campaign.bounds.push_back(0.0);
  Pose2 before = drive.start;
  for (std::size_t i = 0; i < drive.steps.size(); ++i) {
    const DriveStep& step = drive.steps[i];
    ekf.predict(step.measured);
    bound.predict(before, step.truth, control_covariance(step.truth, noise.odometry));
    before = step.pose;
    if (seen[i]) {
      const bool fused = ekf.update(*seen[i]).status == localization::UpdateStatus::fused;
      fused ? ++campaign.fused : ++campaign.other;
      const Landmark& landmark = *map.find(seen[i]->landmark);
      ASSERT_TRUE(bound.update(step.pose, step.bias, landmark, *seen[i]));
    }
    const PoseSample sample{step.pose, ekf.belief().pose, ekf.belief().covariance};
    campaign.errors.back() += difference(sample.estimate, sample.truth).head<2>().squaredNorm();
    campaign.bounds.back() += bound.covariance().topLeftCorner<2, 2>().trace();
    const bool last_of_look = seen[i] && (i + 1 == seen.size() || !seen[i + 1]);
    if (last_of_look) campaign.nees.back().push_back(nees(sample));
  }
}

/// DESIGN's statistics, as for discs. There are 18 look instants: that more than three of them lie
/// outside a 95 % band by chance has a probability of 1 %.
void expect_points_consistent(const DriveNoise& noise) {
  PointsCampaign campaign;
  for (std::uint64_t seed = 0; seed < kPointsRuns; ++seed) run(noise, seed, campaign);
  const Anees consistency = anees(campaign.nees, 3);
  const Estimate ratio = pcrlb_ratio(campaign.errors, campaign.bounds, 1);
  EXPECT_GE(consistency.inside_band, 15.0 / 18.0);
  EXPECT_GT(consistency.mean_per_dof, 0.9);
  EXPECT_LT(consistency.mean_per_dof, 1.1);
  EXPECT_LE(ratio.value, 1.10);
  EXPECT_GT(ratio.interval.high, 1.0);                // nobody beats the bound
  EXPECT_LT(campaign.other, 0.006 * campaign.fused);  // two gates of 99.9 %
}

TEST(EkfPointsConsistency, IsConsistentAndAtTheBoundWithPatternsAndTags) {
  expect_points_consistent({});
}

TEST(EkfPointsConsistency, IsConsistentWithBothPartsOfTheReadingErrorAndCoarserDots) {
  DriveNoise noise;
  noise.sensor.reading_angle = from_deg(0.1);
  noise.pixel_sigma = 0.3;
  expect_points_consistent(noise);
}

}  // namespace
}  // namespace vigia::evaluation
