#include "vigia/localization/stereo_pair.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"

namespace vigia::localization {
namespace {

const StereoPair kPair{554.3, 319.5, 0.03};

TEST(StereoPair, APointThatIsTriangulatedFromItsOwnImageIsTheSame) {
  const Eigen::Vector2d p_r(0.8, -0.3);
  const auto image = stereo_image(kPair, {}, p_r);
  const auto point = triangulate(kPair, {image->columns.x(), image->columns.y()}, 0.1);
  EXPECT_LT((point->p_r - p_r).norm(), 1e-12);
}

TEST(StereoPair, ColumnsMoveAsTheirJacobiansSay) {
  const StereoErrors errors{0.02, 0.004, -0.01};
  const Eigen::Vector2d p_r(0.6, 0.25);
  const auto image = stereo_image(kPair, errors, p_r);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d d = kStep * Eigen::Vector2d::Unit(i);
    const Eigen::Vector2d slope = (stereo_image(kPair, errors, p_r + d)->columns -
                                   stereo_image(kPair, errors, p_r - d)->columns) /
                                  (2.0 * kStep);
    EXPECT_LT((slope - image->dcolumns_dp.col(i)).norm(), 1e-5);
  }
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d up = errors.vector() + kStep * Eigen::Vector3d::Unit(i);
    const Eigen::Vector3d down = errors.vector() - kStep * Eigen::Vector3d::Unit(i);
    const Eigen::Vector2d slope =
        (stereo_image(kPair, {up.x(), up.y(), up.z()}, p_r)->columns -
         stereo_image(kPair, {down.x(), down.y(), down.z()}, p_r)->columns) /
        (2.0 * kStep);
    EXPECT_LT((slope - image->dcolumns_derrors.col(i)).norm(), 1e-5);
  }
}

TEST(StereoPair, TurnedInwardsTheCamerasSeeASmallerDisparity) {
  const Eigen::Vector2d p_r(1.0, 0.0);
  const Eigen::Vector2d straight = stereo_image(kPair, {}, p_r)->columns;
  const Eigen::Vector2d inwards = stereo_image(kPair, {0.0, 0.001, 0.0}, p_r)->columns;
  EXPECT_NEAR((straight.x() - straight.y()) - (inwards.x() - inwards.y()), 0.554, 1e-3);
}

TEST(StereoPair, WhatLiesBehindACameraOrHasNoDisparityHasNoPlace) {
  EXPECT_FALSE(stereo_image(kPair, {}, {-0.5, 0.1}));
  EXPECT_FALSE(triangulate(kPair, {300.0, 300.0}, 0.1));
  EXPECT_FALSE(triangulate(kPair, {300.0, 301.0}, 0.1));
}

TEST(StereoPair, TheSpreadOfNoisyRangesAndBearingsIsTheirCovariance) {
  const Eigen::Vector2d p_r(0.5, 0.2);
  const Eigen::Vector2d columns = stereo_image(kPair, {}, p_r)->columns;
  constexpr double kSigma_px = 0.1;
  constexpr int kDraws = 4000;
  RandomStream random(3, "stereo");
  const PolarSighting exact = polar(*triangulate(kPair, {columns.x(), columns.y()}, kSigma_px));
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const double left = columns.x() + kSigma_px * random.normal();
    const double right = columns.y() + kSigma_px * random.normal();
    const PolarSighting seen = polar(*triangulate(kPair, {left, right}, kSigma_px));
    const Eigen::Vector2d e(seen.range_m - exact.range_m, seen.bearing - exact.bearing);
    scatter += e * e.transpose() / kDraws;
  }
  // A variance of 4000 draws has a relative standard error of √(2/4000) = 2.2 %; four of them.
  EXPECT_NEAR(scatter(0, 0) / exact.covariance(0, 0), 1.0, 0.09);
  EXPECT_NEAR(scatter(1, 1) / exact.covariance(1, 1), 1.0, 0.09);
}

}  // namespace
}  // namespace vigia::localization
