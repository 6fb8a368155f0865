#include "vigia/evaluation/pcrlb.hpp"

#include "evaluation/filter_on_truth.hpp"
#include "localization/drive.hpp"

#include <gtest/gtest.h>

namespace vigia::evaluation {
namespace {

using localization::test::Drive;
using localization::test::DriveStep;

TEST(PosteriorBound, EqualsTheCovarianceOfAFilterThatSitsOnTheTruth) {
  Drive drive = localization::test::simulate_drive({}, 1);
  const LandmarkMap map = localization::test::room_landmarks();
  const auto ekf = test::filter_on_truth(drive);
  PosteriorBound bound(drive.prior.covariance, {head_rig(drive.geometry), {}}, drive.noise.sensor);
  RandomStream random(1, "unused");
  Pose2 before = drive.start;
  for (const DriveStep& step : drive.steps) {
    ekf->predict(step.truth);
    bound.predict(before, step.truth, control_covariance(step.truth, drive.noise.odometry));
    before = step.pose;
    if (!step.seen) continue;
    const Landmark& landmark = *map.find(*step.seen->expected);
    const Shot shot = localization::test::aimed_shot(landmark, drive.geometry, step.pose, {},
                                                     step.seen->shot.look, step.seen->shot.stamp);
    EllipseObservation seen = localization::test::observe(landmark, shot, drive.geometry, step.pose,
                                                          {}, 0.0, 0.0, random);
    seen.covariance = step.seen->covariance;
    ASSERT_EQ(ekf->update(seen).status, localization::UpdateStatus::fused);
    ASSERT_TRUE(bound.update(step.pose, {}, landmark, seen));
    ASSERT_TRUE(ekf->belief().covariance.isApprox(bound.covariance(), 1e-6));
  }
}

TEST(PosteriorBound, InformationOfThePoseAddsToWhatIsKnown) {
  PosteriorBound bound(0.04 * Eigen::Matrix3d::Identity(), {}, {});
  const Eigen::Matrix3d information = Eigen::Vector3d(75.0, 0.0, 25.0).asDiagonal();
  bound.update(information);
  EXPECT_TRUE(bound.covariance().isApprox(
      Eigen::Matrix3d(Eigen::Vector3d(0.01, 0.04, 0.02).asDiagonal()), 1e-12));
}

TEST(PosteriorBound, ALandmarkWithoutAnImageChangesNothing) {
  PosteriorBound bound(0.01 * Eigen::Matrix3d::Identity(), {}, {});
  const Landmark behind = localization::test::disc(1, -3.0, 0.0, 1.0, 0.0);
  EXPECT_FALSE(bound.update({}, {}, behind, EllipseObservation{}));
  EXPECT_TRUE(bound.covariance().isApprox(0.01 * Eigen::Matrix3d::Identity()));
}

}  // namespace
}  // namespace vigia::evaluation
