#include "vigia/core/ground.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/random.hpp"

namespace vigia {
namespace {

/// (δp, δφ) in world axes that takes @p from to @p to.
Eigen::Matrix<double, 6, 1> step_between(const Eigen::Isometry3d& from,
                                         const Eigen::Isometry3d& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  Eigen::Matrix<double, 6, 1> step;
  step << to.translation() - from.translation(), turn.angle() * turn.axis();
  return step;
}

Ground ramp() {
  Eigen::Isometry3d wMg = Eigen::Isometry3d::Identity();
  wMg.linear() = (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitY()))
                     .toRotationMatrix();
  wMg.translation() = Eigen::Vector3d(1.0, -2.0, 0.3);
  return Ground(wMg);
}

void expect_jacobian_of_finite_differences(const Ground& ground) {
  constexpr double kStep = 1e-6;
  RandomStream random(5, "poses");
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d at(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0),
                             random.uniform(-3.0, 3.0));
    Eigen::Matrix<double, 6, 3> numeric;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      numeric.col(k) = step_between(ground.place(Pose2::from_vector(at - step)),
                                    ground.place(Pose2::from_vector(at + step))) /
                       (2.0 * kStep);
    }
    // Rounding of a metre (1e-15) over the step.
    EXPECT_LT((ground.dplace_dpose(Pose2::from_vector(at)) - numeric).norm(), 1e-8);
  }
}

TEST(Ground, IsFlatByDefault) {
  const Pose2 pose{1.5, -0.4, 0.7};
  EXPECT_TRUE(Ground{}.flat());
  EXPECT_EQ(Ground{}.place(pose).matrix(), to_isometry(pose).matrix());
}

TEST(Ground, OfAPlaneCarriesTheRobotInIt) {
  const Eigen::Isometry3d wMr = ramp().place({2.0, 0.0, 0.0});
  // Two metres up a slope of 0.2 rad.
  EXPECT_NEAR(wMr.translation().z(), 0.3 + 2.0 * std::sin(0.2), 1e-12);
  EXPECT_NEAR(wMr.linear()(2, 2), std::cos(0.2), 1e-12);
  EXPECT_FALSE(ramp().flat());
  const Eigen::Vector3d above = ramp().place({2.0, 1.0, 0.3}) * Eigen::Vector3d(0.0, 0.0, 0.5);
  EXPECT_TRUE(ramp().in_plan(above).isApprox(Eigen::Vector3d(2.0, 1.0, 0.5), 1e-12));
}

TEST(Ground, HasTheJacobianOfFiniteDifferences) {
  expect_jacobian_of_finite_differences(Ground{});
  expect_jacobian_of_finite_differences(ramp());
}

/// A level piece, a ramp of 0.08 that rises along x, a level piece above it, another ramp that
/// rises along y from there, and one that falls back along −y.
std::vector<GroundPiece> pieces() {
  const double slope = std::atan(0.08);
  return {{{{0.0, 0.0}, {4.0, 0.0}, {4.0, 2.0}, {0.0, 2.0}}, 0.0, 0.0},
          {{{4.0, 0.0}, {9.0, 0.0}, {9.0, 2.0}, {4.0, 2.0}}, slope, 0.0},
          {{{9.0, 0.0}, {12.0, 0.0}, {12.0, 2.0}, {9.0, 2.0}}, 0.0, 0.0},
          {{{12.0, 2.0}, {12.0, 6.0}, {9.0, 6.0}, {9.0, 2.0}}, slope, 0.5 * kPi}};
}

Ground sheet() {
  return Ground(pieces()).under({0.5, 0.4});
}

TEST(FoldedGround, LiesOnItsPiecesAndKeepsLengthsAlongTheSlope) {
  const double slope = std::atan(0.08);
  EXPECT_FALSE(sheet().flat());
  EXPECT_TRUE(sheet().place({1.0, 1.0, 0.3}).isApprox(to_isometry({1.0, 1.0, 0.3}), 1e-12));
  const Eigen::Isometry3d on_ramp = sheet().place({6.0, 1.0, 0.0});
  EXPECT_NEAR(on_ramp.translation().x(), 4.0 + 2.0 * std::cos(slope), 1e-12);
  EXPECT_NEAR(on_ramp.translation().z(), 2.0 * std::sin(slope), 1e-12);
  EXPECT_NEAR(on_ramp.linear()(2, 0), std::sin(slope), 1e-12);
  // Facing across the slope it rolls: its left side is up.
  EXPECT_NEAR(sheet().place({6.0, 1.0, -0.5 * kPi}).linear()(2, 1), std::sin(slope), 1e-12);
  EXPECT_NEAR(sheet().place({10.5, 1.0, 0.0}).translation().z(), 5.0 * std::sin(slope), 1e-12);
  EXPECT_NEAR(sheet().place({10.5, 5.0, 0.0}).translation().z(), 8.0 * std::sin(slope), 1e-12);
}

TEST(FoldedGround, CarriesARobotAcrossAFoldOverItsWholeWheelbase) {
  const double slope = std::atan(0.08);
  double pitch = -1e-9;
  for (double x = 3.7; x < 4.31; x += 0.05) {
    const Eigen::Isometry3d wMr = sheet().place({x, 1.0, 0.0});
    const double now = std::asin(wMr.linear()(2, 0));
    EXPECT_GE(now, pitch - 1e-12);
    // A continuous motion: 5 cm of the 50 cm between the axles.
    EXPECT_LT(now - pitch, 0.12 * slope);
    EXPECT_TRUE((wMr.linear().transpose() * wMr.linear()).isIdentity(1e-12));
    pitch = now;
  }
  EXPECT_NEAR(pitch, slope, 1e-12);
  // Half way the front is up by what it has climbed, the rear still level.
  const Eigen::Isometry3d half = sheet().place({4.0, 1.0, 0.0});
  EXPECT_NEAR(std::asin(half.linear()(2, 0)), 0.5 * slope, 1e-4);
  EXPECT_NEAR(half.translation().z(), 0.25 * 0.25 * std::sin(slope), 1e-12);
}

// The poses lie within the sheet, some of them across its folds; a contact at the very fold would
// have no derivative, and none of these is.
TEST(FoldedGround, HasTheJacobianOfFiniteDifferences) {
  constexpr double kStep = 1e-6;
  RandomStream random(7, "poses");
  int across = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d at(random.uniform(0.3, 11.7), random.uniform(0.3, 1.9),
                             random.uniform(-3.0, 3.0));
    Eigen::Matrix<double, 6, 3> numeric;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      numeric.col(k) = step_between(sheet().place(Pose2::from_vector(at - step)),
                                    sheet().place(Pose2::from_vector(at + step))) /
                       (2.0 * kStep);
    }
    EXPECT_LT((sheet().dplace_dpose(Pose2::from_vector(at)) - numeric).norm(), 1e-7)
        << at.transpose();
    if (numeric.bottomLeftCorner<3, 2>().norm() > 1e-6) ++across;
  }
  EXPECT_GT(across, 20);
}

TEST(FoldedGround, LiftsAndLaysOutPointsAlike) {
  RandomStream random(3, "points");
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p(random.uniform(0.0, 12.0), random.uniform(0.0, 2.0),
                            random.uniform(0.0, 2.5));
    const Eigen::Vector3d p_w = sheet().lift(p.head<2>(), p.z());
    EXPECT_LT((sheet().in_plan(p_w) - p).norm(), 1e-9);
  }
}

TEST(FoldedGround, HangsLandmarksUprightOnWallsThatStandOnASlope) {
  const Ground ground = sheet();
  const Eigen::Isometry3d wMl = ground.hang(wall_mount({6.0, 2.0, 2.15}, -0.5 * kPi));
  EXPECT_TRUE(wMl.translation().isApprox(ground.lift({6.0, 2.0}, 2.15), 1e-12));
  EXPECT_TRUE(wMl.linear().isApprox(wall_mount({}, -0.5 * kPi).linear(), 1e-12));
}

TEST(FoldedGround, OfAWrongMapHasSteeperRampsAndHigherFloorsAtTheirEnds) {
  const double off = from_deg(1.0);
  const double slope = std::atan(0.08);
  const Ground wrong = sheet().with_steeper_ramps(off);
  EXPECT_NEAR(std::asin(wrong.place({6.5, 1.0, 0.0}).linear()(2, 0)), slope + off, 1e-9);
  EXPECT_NEAR(std::asin(wrong.place({10.5, 4.0, 0.5 * kPi}).linear()(2, 0)), slope + off, 1e-9);
  EXPECT_NEAR(wrong.place({10.5, 1.0, 0.0}).translation().z(), 5.0 * std::sin(slope + off), 1e-9);
  const Pose2 level{1.0, 1.0, 0.0};
  EXPECT_EQ(wrong.place(level).matrix(), sheet().place(level).matrix());
  EXPECT_TRUE(sheet()
                  .with_steeper_ramps(0.0)
                  .place({6.5, 1.0, 0.0})
                  .isApprox(sheet().place({6.5, 1.0, 0.0}), 1e-9));
}

TEST(FoldedGround, RejectsAPieceThatHasNoHinge) {
  auto apart = pieces();
  apart[2].polygon = {{20.0, 0.0}, {22.0, 0.0}, {22.0, 2.0}, {20.0, 2.0}};
  EXPECT_THROW(Ground{apart}, std::invalid_argument);
  // Side by side, but the shared edge rises on one side only.
  auto twisted = pieces();
  twisted[2].polygon = {{4.0, 2.0}, {9.0, 2.0}, {9.0, 4.0}, {4.0, 4.0}};
  EXPECT_THROW(Ground{twisted}, std::invalid_argument);
  auto hollow = pieces();
  hollow[0].polygon = {{0.0, 0.0}, {4.0, 0.0}, {1.0, 1.0}, {0.0, 2.0}};
  EXPECT_THROW(Ground{hollow}, std::invalid_argument);
}

}  // namespace
}  // namespace vigia
