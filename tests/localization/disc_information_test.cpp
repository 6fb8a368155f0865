#include "vigia/localization/disc_information.hpp"

#include "localization/room.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/localization/ekf.hpp"

namespace vigia::localization {
namespace {

const Pose2 kDiscPose{4.0, 3.0, 0.2};

DiscInformation disc_information() {
  return DiscInformation({}, test::zoom_calibration(), {});
}

TEST(DiscInformation, EqualsWhatOneLookTeachesTheFilter) {
  const Landmark landmark = *test::room_landmarks().find(4);
  const auto information = disc_information().look_information(landmark, kDiscPose);
  ASSERT_TRUE(information);

  EkfParams params;
  params.centre_floor_px = 0.0;
  params.size_floor = 0.0;
  EkfLocalizer ekf(test::room_landmarks(), {}, params);
  const Eigen::Vector3d sigma(0.05, 0.05, from_deg(1.0));
  const Eigen::Matrix3d prior = sigma.cwiseAbs2().asDiagonal();
  ekf.reset({}, {kDiscPose, prior});
  RandomStream random(1, "unused");
  const Shot shot = test::aimed_shot(landmark, {}, kDiscPose, {}, 1, {});
  EllipseObservation seen = test::observe(landmark, shot, {}, kDiscPose, {}, 0.0, 0.0, random);
  seen.covariance = 0.02 * 0.02 * Eigen::Matrix<double, 5, 5>::Identity();
  ASSERT_EQ(ekf.update(seen).status, UpdateStatus::fused);
  const Eigen::Matrix3d expected = (prior.inverse() + *information).inverse();
  EXPECT_LT((ekf.belief().covariance - expected).norm(), 1e-3 * expected.norm());
}

TEST(DiscInformation, IsPositiveDefiniteAndGreaterFromNearer) {
  const Landmark landmark = test::disc(1, 4.0, 7.0, 1.5, -90.0);
  const auto near = disc_information().look_information(landmark, {4.0, 5.0, 0.0});
  const auto far = disc_information().look_information(landmark, {4.0, 1.0, 0.0});
  ASSERT_TRUE(near && far);
  EXPECT_GT(near->selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
  EXPECT_GT(near->determinant(), far->determinant());
}

TEST(DiscInformation, IsNothingFromBehindAndTooCloseToFit) {
  const Landmark landmark = test::disc(1, 4.0, 3.0, 1.0, 180.0);
  EXPECT_TRUE(disc_information().look_information(landmark, {2.0, 3.0, 0.0}));
  EXPECT_FALSE(disc_information().look_information(landmark, {6.0, 3.0, 0.0}));
  EXPECT_FALSE(
      disc_information().look_information(landmark, {3.65, 3.0, 0.0}));  // 0.2 m: 350 px of radius
}

}  // namespace
}  // namespace vigia::localization
