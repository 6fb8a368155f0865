#include "vigia/localization/points_pose.hpp"

#include "localization/points_views.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "vigia/localization/view_parameters.hpp"

namespace vigia::localization {
namespace {

const Landmark kPosePattern = test::pattern(1, 0.0, 0.0, 0.0, 0.0);
const Landmark kTag = test::tag(2, 0.0, 0.0, 0.0, 0.0);
const Intrinsics kWide{640, 480, 700.0, 710.0, 320.0, 238.0, 0.06};

PointsPose solve(const Landmark& landmark, const Intrinsics& lens, const Eigen::Isometry3d& cMl,
                 double sigma, RandomStream& random) {
  const auto seen = test::observe_points(landmark, lens, cMl, sigma, random);
  return solve_points(seen_points(landmark, seen), lens);
}

Eigen::Isometry3d pose_at(double phi_deg, double distance) {
  Eigen::Isometry3d cMl = pose_of({from_deg(phi_deg), from_deg(35.0), from_deg(-8.0), distance});
  cMl.translation() += Eigen::Vector3d(0.03, -0.02, 0.0) * distance;
  return cMl;
}

TEST(PointsPose, RecoversAnyViewOfPatternAndTagThroughADistortingLens) {
  RandomStream random(1, "unused");
  for (const Landmark& landmark : {kPosePattern, kTag}) {
    for (const double phi : {2.0, 20.0, 45.0, 70.0}) {
      for (const double distance : {0.7, 2.0, 5.0}) {
        const Eigen::Isometry3d truth = pose_at(phi, distance);
        const PointsPose found = solve(landmark, kWide, truth, 0.0, random);
        ASSERT_TRUE(found.has_pose()) << phi << "° " << distance << " m";
        EXPECT_LT(move_between(truth, found.pose.cMl).norm(), 1e-6) << phi << "° " << distance;
        EXPECT_LT(found.pose.chi2, 1e-6);
        EXPECT_EQ(found.frontal, found.phi < from_deg(25.0));
      }
    }
  }
}

TEST(PointsPose, ReportsTheMirroredTwinWithTheLargerResidual) {
  RandomStream random(1, "unused");
  const Eigen::Isometry3d truth = pose_at(30.0, 4.0);
  const PointsPose found = solve(kTag, test::evi_d31(), truth, 0.0, random);
  ASSERT_TRUE(found.twin);
  EXPECT_GT(found.twin->chi2, found.pose.chi2);
  // The twin's own minimum is near the mirrored pose, and far from the pose.
  EXPECT_LT(move_between(twin_of(truth), found.twin->cMl).tail<3>().norm(), from_deg(10.0));
  EXPECT_GT(move_between(truth, found.twin->cMl).tail<3>().norm(), from_deg(40.0));
}

TEST(PointsPose, IsAmbiguousWhenNoiseHidesThePerspective) {
  RandomStream random(3, "noise");
  const PointsPose far = solve(kTag, kWide, pose_at(30.0, 6.0), 0.5, random);
  EXPECT_EQ(far.status, PointsPoseStatus::ambiguous);
  EXPECT_TRUE(far.twin);
  const PointsPose near = solve(kPosePattern, test::evi_d31(), pose_at(45.0, 1.6), 0.1, random);
  EXPECT_EQ(near.status, PointsPoseStatus::solved);
}

TEST(PointsPose, IsSolvedByFiveOfSeventeenDots) {
  RandomStream random(1, "unused");
  const Eigen::Isometry3d truth = pose_at(40.0, 2.0);
  auto seen = test::observe_points(kPosePattern, kWide, truth, 0.0, random);
  seen.points.erase(seen.points.begin() + 1, seen.points.end() - 4);
  const auto found = solve_points(seen_points(kPosePattern, seen), kWide);
  ASSERT_TRUE(found.has_pose());
  EXPECT_LT(move_between(truth, found.pose.cMl).norm(), 1e-6);
  EXPECT_EQ(found.pose.dof, 4);
}

TEST(PointsPose, ThreePointsAreTooFewAndFourOnALineDegenerate) {
  RandomStream random(1, "unused");
  auto seen = test::observe_points(kPosePattern, kWide, pose_at(40.0, 2.0), 0.0, random);
  const std::vector<LabelledPoint> all = seen.points;
  seen.points = {all[0], all[1], all[2]};
  EXPECT_EQ(solve_points(seen_points(kPosePattern, seen), kWide).status, PointsPoseStatus::too_few);
  seen.points = {all[0], all[1], all[5], all[9], all[13]};  // first and fifth of both rings
  EXPECT_EQ(solve_points(seen_points(kPosePattern, seen), kWide).status,
            PointsPoseStatus::degenerate);
}

/// NEES of 6 degrees of freedom and χ² of the residuals over many noisy views.
struct Spread {
  double nees = 0.0;
  double chi2_per_dof = 0.0;
};

Spread spread_of(const Landmark& landmark, const Eigen::Isometry3d& truth, double sigma, int runs) {
  RandomStream random(11, "noise");
  Spread spread;
  for (int i = 0; i < runs; ++i) {
    const PointsPose found = solve(landmark, test::evi_d31(), truth, sigma, random);
    EXPECT_TRUE(found.has_pose());
    const PoseVector e = move_between(found.pose.cMl, truth);
    spread.nees += e.dot(found.pose.covariance.ldlt().solve(e)) / runs;
    spread.chi2_per_dof += found.pose.chi2 / found.pose.dof / runs;
  }
  return spread;
}

TEST(PointsPose, ItsCovarianceIsThatOfItsErrors) {
  constexpr int kRuns = 1000;
  // Four standard errors of a mean of χ² of 6 dof, and of χ²/dof.
  const double nees_tolerance = 4.0 * std::sqrt(2.0 * 6.0 / kRuns);
  const Spread pattern = spread_of(kPosePattern, pose_at(45.0, 2.5), 0.5, kRuns);
  EXPECT_NEAR(pattern.nees, 6.0, nees_tolerance);
  EXPECT_NEAR(pattern.chi2_per_dof, 1.0, 4.0 * std::sqrt(2.0 / 28.0 / kRuns));
  const Spread tag = spread_of(kTag, pose_at(45.0, 2.5), 0.2, kRuns);
  EXPECT_NEAR(tag.nees, 6.0, nees_tolerance);
  EXPECT_NEAR(tag.chi2_per_dof, 1.0, 4.0 * std::sqrt(2.0 / 2.0 / kRuns));
}

TEST(PointsPose, AFocalLengthThatIsOffMovesThePoseAsItSays) {
  RandomStream random(1, "unused");
  const Eigen::Isometry3d truth = pose_at(45.0, 2.0);
  const auto seen = test::observe_points(kPosePattern, test::evi_d31(), truth, 0.0, random);
  const auto points = seen_points(kPosePattern, seen);
  Intrinsics longer = test::evi_d31();
  constexpr double kStep = 1e-4;
  longer.px *= std::exp(kStep);
  longer.py *= std::exp(kStep);
  const PointsPose exact = solve_points(points, test::evi_d31());
  const PointsPose shifted = solve_points(points, longer);
  const PoseVector numeric = move_between(exact.pose.cMl, shifted.pose.cMl) / kStep;
  EXPECT_LT((numeric - exact.pose.dpose_dlog_focal).norm(), 1e-3 * numeric.norm());
}

}  // namespace
}  // namespace vigia::localization
