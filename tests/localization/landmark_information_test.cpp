#include "vigia/localization/landmark_information.hpp"

#include "localization/points_drive.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/localization/ekf.hpp"

namespace vigia::localization {
namespace {

const Pose2 kHere{4.0, 3.0, 0.2};

/// Of one image, as far as points go.
LandmarkInformation information() {
  LandmarkInformationParams params;
  params.frames_per_look = 1.0;
  return LandmarkInformation({}, test::zoom_calibration(), params);
}

TEST(LandmarkInformation, OfADiscEqualsWhatOneLookTeachesTheFilter) {
  const Landmark landmark = *test::room_landmarks().find(4);
  const auto taught = information().look_information(landmark, kHere);
  ASSERT_TRUE(taught);

  EkfParams params;
  params.centre_floor_px = 0.0;
  params.size_floor = 0.0;
  EkfLocalizer ekf(test::room_landmarks(), {}, params);
  const Eigen::Vector3d sigma(0.05, 0.05, from_deg(1.0));
  const Eigen::Matrix3d prior = sigma.cwiseAbs2().asDiagonal();
  ekf.reset({}, Prior{kHere, prior});
  RandomStream random(1, "unused");
  const Shot shot = test::aimed_shot(landmark, {}, kHere, {}, 1, {});
  EllipseObservation seen = test::observe(landmark, shot, {}, kHere, {}, 0.0, 0.0, random);
  seen.covariance = 0.02 * 0.02 * Eigen::Matrix<double, 5, 5>::Identity();
  ASSERT_EQ(ekf.update(seen).status, UpdateStatus::fused);
  const Eigen::Matrix3d expected = (prior.inverse() + *taught).inverse();
  EXPECT_LT((ekf.belief().covariance - expected).norm(), 1e-3 * expected.norm());
}

TEST(LandmarkInformation, OfADiscIsPositiveDefiniteAndGreaterFromNearer) {
  const Landmark landmark = test::disc(1, 4.0, 7.0, 1.5, -90.0);
  const auto near = information().look_information(landmark, {4.0, 5.0, 0.0});
  const auto far = information().look_information(landmark, {4.0, 1.0, 0.0});
  ASSERT_TRUE(near && far);
  EXPECT_GT(near->selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
  EXPECT_GT(near->determinant(), far->determinant());
}

TEST(LandmarkInformation, OfADiscIsNothingFromBehindAndTooCloseToFit) {
  const Landmark landmark = test::disc(1, 4.0, 3.0, 1.0, 180.0);
  EXPECT_TRUE(information().look_information(landmark, {2.0, 3.0, 0.0}));
  EXPECT_FALSE(information().look_information(landmark, {6.0, 3.0, 0.0}));
  EXPECT_FALSE(
      information().look_information(landmark, {3.65, 3.0, 0.0}));  // 0.2 m: 350 px of radius
}

TEST(LandmarkInformation, OfPointsEqualsWhatOneImageTeachesTheFilter) {
  for (const Landmark& landmark :
       {test::pattern(4, 6.0, 3.9, 1.5, 180.0), test::tag(4, 6.0, 3.9, 1.5, 180.0)}) {
    const auto taught = information().look_information(landmark, kHere);
    ASSERT_TRUE(taught);
    EkfParams params;
    params.centre_floor_px = 0.0;
    EkfLocalizer ekf(LandmarkMap({landmark}), {}, params);
    const Eigen::Vector3d sigma(0.05, 0.05, from_deg(1.0));
    const Eigen::Matrix3d prior = sigma.cwiseAbs2().asDiagonal();
    ekf.reset({}, Prior{kHere, prior});
    Shot shot;
    shot.look = 1;
    shot.head = aim_at({}, to_isometry(kHere).inverse() * landmark.centre_w());
    const double range =
        (to_isometry(kHere) * Eigen::Vector3d(0.15, 0.0, 1.0) - landmark.centre_w()).norm();
    double reach = 0.0;
    for (const LandmarkPoint& point : landmark_points(landmark))
      reach = std::max(reach, point.centre_l.norm() + point.radius_m);
    const ZoomCalibration zoom = test::zoom_calibration();
    shot.model = zoom.at(zoom.zoom_for_focal(0.8 * 240.0 * range / reach));
    RandomStream random(1, "unused");
    PointsObservation seen =
        test::observe_points(landmark, shot, {}, to_isometry(kHere), {}, 0.0, 0.0, random);
    for (LabelledPoint& point : seen.points) point.covariance = 0.01 * Eigen::Matrix2d::Identity();
    ASSERT_EQ(ekf.update(seen).status, UpdateStatus::fused);
    const Eigen::Matrix3d expected = (prior.inverse() + *taught).inverse();
    EXPECT_LT((ekf.belief().covariance - expected).norm(), 1e-3 * expected.norm());
  }
}

TEST(LandmarkInformation, APatternTeachesMoreFromNearerAndNothingFromBehind) {
  const Landmark landmark = test::pattern(4, 6.0, 3.9, 1.5, 180.0);
  const auto near = information().look_information(landmark, {4.0, 3.0, 0.0});
  const auto far = information().look_information(landmark, {1.0, 1.65, 0.0});
  ASSERT_TRUE(near && far);
  EXPECT_GT(near->selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
  EXPECT_GT(near->determinant(), far->determinant());
  EXPECT_FALSE(information().look_information(landmark, {8.0, 3.0, 0.0}));
}

}  // namespace
}  // namespace vigia::localization
