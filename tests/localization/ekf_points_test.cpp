#include "localization/points_drive.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/localization/ekf.hpp"

namespace vigia::localization {
namespace {

const Pose2 kTruth{4.0, 3.0, 0.2};
const Landmark kSeenPattern = test::pattern(4, 5.6, 3.9, 1.5, 180.0);
const LookBias kBias{0.004, -0.003, 0.002};

EkfParams points_params() {
  EkfParams params;
  params.iterations = 20;
  params.converged = 1e-8;
  return params;
}

PointsObservation seen_by(const Landmark& landmark, double sigma, std::uint64_t seed) {
  RandomStream random(seed, "points");
  Shot shot;
  shot.look = 1;
  const HeadAngles aim = aim_at({}, to_isometry(kTruth).inverse() * landmark.centre_w());
  shot.head = {aim.pan - kBias.pan, aim.tilt - kBias.tilt};
  shot.model = test::zoom_calibration().at(24.0);
  return test::observe_points(landmark, shot, {}, to_isometry(kTruth), kBias, 0.0, sigma, random);
}

Prior prior_about(const Pose2& pose) {
  const Eigen::Vector3d sigma(0.05, 0.05, from_deg(1.0));
  return {pose, sigma.cwiseAbs2().asDiagonal()};
}

/// Hᵀy, which does not depend on how the points were compressed.
Vector6 gradient_at(const PointsObservation& seen, const Vector6& x) {
  const auto measured = measure_points(seen_points(kSeenPattern, seen), kSeenPattern.wMl, seen.shot,
                                       {}, Pose2::from_vector(x.head<3>()), {x(3), x(4), x(5)});
  return measured->H.transpose() * measured->y;
}

TEST(EkfPoints, TheCompressedJacobianEqualsFiniteDifferences) {
  const PointsObservation seen = seen_by(kSeenPattern, 0.0, 1);
  Vector6 truth;
  truth << kTruth.vector(), kBias.pan, kBias.tilt, kBias.log_focal;
  const auto measured = measure_points(seen_points(kSeenPattern, seen), kSeenPattern.wMl, seen.shot,
                                       {}, kTruth, kBias);
  ASSERT_TRUE(measured);
  EXPECT_LT(measured->chi2, 1e-12);
  const Matrix6 information = measured->H.transpose() * measured->H;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Vector6 h = 1e-6 * Vector6::Unit(i);
    const Vector6 numeric = (gradient_at(seen, truth - h) - gradient_at(seen, truth + h)) / 2e-6;
    EXPECT_LT((information.col(i) - numeric).norm(), 1e-3 * numeric.norm()) << i;
  }
}

TEST(EkfPoints, OneImageTeachesWhatItsInformationSays) {
  EkfLocalizer ekf(LandmarkMap({kSeenPattern}), {}, points_params());
  const Prior prior = prior_about({4.03, 2.98, 0.21});
  ekf.reset({}, prior);
  const PointsObservation seen = seen_by(kSeenPattern, 0.1, 1);
  const UpdateResult result = ekf.update(seen);
  ASSERT_EQ(result.status, UpdateStatus::fused);
  EXPECT_EQ(result.dof, 5);  // a turn about the camera and a pan back leave no trace
  EXPECT_EQ(result.landmark, kSeenPattern.id);

  // The state is a stationary point of prior and points, its covariance the inverse information.
  const Vector6 x = ekf.state().mean;
  const auto points = seen_points(kSeenPattern, seen, points_params().centre_floor_px);
  const auto measured = measure_points(points, kSeenPattern.wMl, seen.shot, {},
                                       Pose2::from_vector(x.head<3>()), {x(3), x(4), x(5)});
  Matrix6 information = Matrix6::Zero();
  information.topLeftCorner<3, 3>() = prior.covariance.inverse();
  information.bottomRightCorner<3, 3>() = look_covariance(points_params().sensor).inverse();
  Vector6 start = Vector6::Zero();
  start.head<3>() = prior.pose.vector();
  const Vector6 pull = information * (start - x) + measured->H.transpose() * measured->y;
  information += measured->H.transpose() * measured->H;
  EXPECT_LT(information.ldlt().solve(pull).norm(), 1e-7);
  const Matrix6 expected = information.inverse();
  EXPECT_LT((ekf.state().covariance - expected).norm(), 1e-4 * expected.norm());
}

TEST(EkfPoints, ALandmarkThatIsNotOfTheMapIsGated) {
  EkfLocalizer ekf(LandmarkMap({kSeenPattern}), {}, {});
  ekf.reset({}, prior_about(kTruth));
  PointsObservation seen = seen_by(kSeenPattern, 0.1, 1);
  seen.landmark = 5;
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::gated);
}

TEST(EkfPoints, TheImageOfAnotherLandmarkIsGated) {
  Landmark other = kSeenPattern;
  other.id = 5;
  other.wMl.translation().y() += 0.4;
  EkfLocalizer ekf(LandmarkMap({kSeenPattern, other}), {}, {});
  ekf.reset({}, prior_about(kTruth));
  PointsObservation seen = seen_by(kSeenPattern, 0.1, 1);
  seen.landmark = 5;
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::gated);
  seen.landmark = 4;
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::fused);
}

TEST(EkfPoints, APatternWithOneDotAstrayIsGated) {
  EkfLocalizer ekf(LandmarkMap({kSeenPattern}), {}, {});
  ekf.reset({}, prior_about(kTruth));
  PointsObservation seen = seen_by(kSeenPattern, 0.1, 1);
  seen.points[7].uv.x() += 1.5;
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::gated);
}

TEST(EkfPoints, AnImageWithoutUsablePointsIsDegenerate) {
  EkfLocalizer ekf(LandmarkMap({kSeenPattern}), {}, {});
  ekf.reset({}, prior_about(kTruth));
  PointsObservation seen = seen_by(kSeenPattern, 0.1, 1);
  seen.points.clear();
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::degenerate);
  seen = seen_by(kSeenPattern, 0.1, 1);
  for (LabelledPoint& point : seen.points) point.label += 100;
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::degenerate);
}

TEST(EkfPoints, RightImagesPassTheGateAsOftenAsItSays) {
  constexpr int kRuns = 2000;
  EkfParams params;
  params.gate_probability = 0.99;
  params.centre_floor_px = 0.0;
  int gated = 0;
  double nis = 0.0;
  RandomStream random(5, "gate");
  for (int i = 0; i < kRuns; ++i) {
    EkfLocalizer ekf(LandmarkMap({kSeenPattern}), {}, params);
    Prior prior = prior_about(kTruth);
    const Eigen::Vector3d sigma = prior.covariance.diagonal().cwiseSqrt();
    prior.pose = {kTruth.x + sigma.x() * random.normal(), kTruth.y + sigma.y() * random.normal(),
                  kTruth.theta + sigma.z() * random.normal()};
    ekf.reset({}, prior);
    const LookBias bias = test::draw_bias(random, params.sensor);
    Shot shot = seen_by(kSeenPattern, 0.0, 1).shot;
    const auto seen =
        test::observe_points(kSeenPattern, shot, {}, to_isometry(kTruth), bias, 0.0, 0.1, random);
    const UpdateResult result = ekf.update(seen);
    if (result.status != UpdateStatus::fused) ++gated;
    nis += result.nis / kRuns;
  }
  // Two tests at 1 %: 2 % of the images, four standard errors of a binomial; NIS of 5 dof.
  const double share = 1.0 - 0.99 * 0.99;
  EXPECT_NEAR(gated, share * kRuns, 4.0 * std::sqrt(share * (1.0 - share) * kRuns));
  EXPECT_NEAR(nis, 5.0, 4.0 * std::sqrt(10.0 / kRuns));
}

TEST(EkfPoints, ImagesInReverseOrderGiveWhatTheyGiveInOrder) {
  EkfLocalizer in_order(LandmarkMap({kSeenPattern}), {}, points_params());
  in_order.reset({}, prior_about({4.02, 3.01, 0.19}));
  EkfLocalizer reversed = in_order;
  std::vector<PointsObservation> images;
  for (int i = 0; i < 5; ++i) {
    images.push_back(seen_by(kSeenPattern, 0.1, static_cast<std::uint64_t>(i)));
    images.back().shot.stamp = Stamp::from_seconds(0.04 * i);
  }
  std::vector<OdometryIncrement> still;
  for (int i = 0; i < 4; ++i)
    still.push_back(
        {Stamp::from_seconds(0.04 * i), Stamp::from_seconds(0.04 * (i + 1)), 0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_EQ(in_order.update(images[i]).status, UpdateStatus::fused);
    if (i < still.size()) in_order.predict(still[i]);
  }
  for (const OdometryIncrement& u : still) reversed.predict(u);
  for (auto image = images.rbegin(); image != images.rend(); ++image)
    EXPECT_EQ(reversed.update(*image).status, UpdateStatus::fused);
  EXPECT_LT((in_order.state().mean - reversed.state().mean).norm(), 1e-9);
  EXPECT_LT((in_order.state().covariance - reversed.state().covariance).norm(), 1e-12);
}

}  // namespace
}  // namespace vigia::localization
