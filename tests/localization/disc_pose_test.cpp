#include "vigia/localization/disc_pose.hpp"

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"
#include "vigia/localization/disc_model.hpp"

namespace vigia::localization {
namespace {

using Matrix5 = Eigen::Matrix<double, 5, 5>;

constexpr double kRadius = 0.1;

Eigen::Isometry3d slanted(double pan, double tilt, const Eigen::Vector3d& centre) {
  Eigen::Isometry3d cMl = Eigen::Isometry3d::Identity();
  cMl.linear() = (Eigen::AngleAxisd(kPi + pan, Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
  cMl.translation() = centre;
  return cMl;
}

Ellipse image_of(const Eigen::Isometry3d& cMl, const Intrinsics& camera) {
  Landmark disc;
  disc.wMl = cMl;
  disc.shape = DiscShape{kRadius};
  return *disc_image(disc, camera, Eigen::Isometry3d::Identity());
}

Matrix5 small_covariance() {
  Matrix5 covariance = Matrix5::Zero();
  covariance.diagonal() << 1e-4, 1e-4, 1e-4, 1e-4, 1e-6;
  return covariance;
}

TEST(DiscPose, OneOfTheTwoPosesIsTheTruthWithAndWithoutALens) {
  for (const double kdu : {0.0, 0.03}) {
    Intrinsics camera;
    camera.kdu = kdu;
    for (const double pan : {-0.7, 0.3, 0.9})
      for (const double tilt : {-0.4, 0.2}) {
        const Eigen::Isometry3d truth = slanted(pan, tilt, {0.3, -0.2, 2.5});
        const auto poses = disc_poses(image_of(truth, camera), small_covariance(), kRadius, camera);
        ASSERT_EQ(poses.size(), 2U);
        double best = 1e9;
        for (const DiscPose& pose : poses)
          best = std::min(best, (pose.cMl.translation() - truth.translation()).norm() +
                                    (pose.cMl.linear().col(2) - truth.linear().col(2)).norm());
        EXPECT_LT(best, 2e-4) << kdu << ' ' << pan << ' ' << tilt;
      }
  }
}

TEST(DiscPose, TheCovarianceIsThatOfTheErrors) {
  const Intrinsics camera;
  const Eigen::Isometry3d truth = slanted(0.6, 0.3, {0.3, -0.2, 2.5});
  const Ellipse seen = image_of(truth, camera);
  Matrix5 covariance = Matrix5::Zero();
  covariance.diagonal() << 1e-4, 1e-4, 2e-4, 2e-4, 1e-6;
  RandomStream random(7, "disc pose");
  constexpr int kDraws = 2000;
  double nees = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    Ellipse noisy = seen;
    noisy.u += 0.01 * random.normal();
    noisy.v += 0.01 * random.normal();
    noisy.a += std::sqrt(2e-4) * random.normal();
    noisy.b += std::sqrt(2e-4) * random.normal();
    noisy.psi += 1e-3 * random.normal();
    double best = 1e9;
    for (const DiscPose& pose : disc_poses(noisy, covariance, kRadius, camera)) {
      // Along the disc's axes, without the turn about its normal.
      Eigen::Matrix<double, 5, 6> axes = Eigen::Matrix<double, 5, 6>::Zero();
      axes.topLeftCorner<3, 3>().setIdentity();
      axes.bottomRightCorner<2, 3>() = pose.cMl.linear().leftCols<2>().transpose();
      Eigen::Matrix<double, 6, 1> error;
      error << truth.translation() - pose.cMl.translation(),
          pose.cMl.linear().col(2).cross(truth.linear().col(2));
      const Eigen::Matrix<double, 5, 1> e = axes * error;
      best = std::min(best, e.dot((axes * pose.covariance * axes.transpose()).ldlt().solve(e)));
    }
    nees += best / (5.0 * kDraws);
  }
  // 4 standard errors of χ²₅/5 over 2000 draws: 0.057.
  EXPECT_NEAR(nees, 1.0, 0.06);
}

TEST(DiscPose, AFrontalDiscHasAPoseWhoseTiltIsSaidToBePoor) {
  const Intrinsics camera;
  const auto poses =
      disc_poses({319.5, 239.5, 28.0, 28.0, 0.0}, 1e-4 * Matrix5::Identity(), kRadius, camera);
  ASSERT_FALSE(poses.empty());
  EXPECT_NEAR(poses[0].cMl.translation().z(), 700.0 * kRadius / 28.0, 1e-6);
  EXPECT_GT(poses[0].covariance(3, 3), 0.1);
}

TEST(DiscPose, WhatIsNoDiscInFrontOfTheCameraHasNone) {
  EXPECT_TRUE(disc_poses({319.5, 239.5, 0.0, 0.0, 0.0}, small_covariance(), kRadius, {}).empty());
}

}  // namespace
}  // namespace vigia::localization
