#include "vigia/core/odometry.hpp"

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"

namespace vigia {
namespace {

constexpr double kStep = 1e-6;
constexpr double kTolerance = 1e-8;  // truncation kStep², rounding 1e-16/kStep · 10 m

OdometryIncrement with_control(const Eigen::Vector3d& c) {
  OdometryIncrement u;
  u.rot1 = c.x();
  u.trans = c.y();
  u.rot2 = c.z();
  return u;
}

struct Drawn {
  Pose2 pose;
  Eigen::Vector3d control;
};

Drawn draw(RandomStream& random) {
  return {{random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-3.1, 3.1)},
          {random.uniform(-1.0, 1.0), random.uniform(-2.0, 2.0), random.uniform(-1.0, 1.0)}};
}

TEST(Odometry, OfAnOmnidirectionalBaseIsTheArcOfItsThreeRates) {
  RandomStream random(7, "crab");
  for (int i = 0; i < 50; ++i) {
    const Pose2 start{1.0, -2.0, random.uniform(-3.0, 3.0)};
    const BaseRates rates{random.uniform(-0.5, 0.5), random.uniform(-1.0, 1.0),
                          random.uniform(-0.5, 0.5)};
    const Stamp end = Stamp::from_seconds(0.8);
    // Many short steps in the directions of the base.
    constexpr int kSteps = 20000;
    Pose2 pose = start;
    for (int k = 0; k < kSteps; ++k) {
      const double h = 0.8 / kSteps;
      const double middle = pose.theta + 0.5 * rates.w * h;
      pose.x += h * (rates.v * std::cos(middle) - rates.vy * std::sin(middle));
      pose.y += h * (rates.v * std::sin(middle) + rates.vy * std::cos(middle));
      pose.theta += rates.w * h;
    }
    const OdometryIncrement u = arc_increment(rates, {}, end);
    EXPECT_LT(difference(move(start, u), pose).norm(), 1e-8);
    const OdometryIncrement seen = crab_increment(start, move(start, u), 0.8 * rates.w, {}, end);
    EXPECT_LT(difference(move(start, seen), pose).norm(), 1e-8);
    EXPECT_NEAR(seen.trans, u.trans, 1e-12);
    EXPECT_NEAR(wrap_angle(seen.crab - u.crab), 0.0, 1e-9);
  }
}

TEST(Odometry, GoingSidewaysIsNoTurn) {
  const OdometryNoise noise{0.0, 0.0, 0.02};
  const OdometryIncrement u = arc_increment({0.0, 0.0, 0.3}, {}, Stamp::from_seconds(1.0));
  EXPECT_NEAR(u.rot1, kPi / 2.0, 1e-12);
  EXPECT_TRUE(control_covariance(u, noise).isZero(1e-20));
  const BaseRates back = mean_rates(u);
  EXPECT_NEAR(back.v, 0.0, 1e-15);
  EXPECT_NEAR(back.vy, 0.3, 1e-15);
}

TEST(Odometry, OfAUnicycleIsTheSameBitsWhicheverWayItIsAskedFor) {
  const Stamp end = Stamp::from_seconds(0.04);
  for (const double v : {0.3, -0.2, 0.0}) {
    const OdometryIncrement a = arc_increment(v, 0.4, {}, end);
    const OdometryIncrement b = arc_increment(BaseRates{v, 0.4}, {}, end);
    EXPECT_EQ(a.rot1, b.rot1);
    EXPECT_EQ(a.trans, b.trans);
    EXPECT_EQ(a.rot2, b.rot2);
    EXPECT_EQ(b.crab, 0.0);
  }
}

TEST(Odometry, MovesAlongTheDirectionAfterTheFirstTurn) {
  const Pose2 moved = move({1.0, 2.0, 0.0}, with_control({kPi / 2.0, 1.0, kPi / 4.0}));
  EXPECT_NEAR(moved.x, 1.0, 1e-15);
  EXPECT_NEAR(moved.y, 3.0, 1e-15);
  EXPECT_NEAR(moved.theta, 0.75 * kPi, 1e-15);
}

TEST(Odometry, HasTheJacobianByThePoseOfFiniteDifferences) {
  RandomStream random(1, "odometry");
  for (int i = 0; i < 100; ++i) {
    const auto [pose, control] = draw(random);
    Eigen::Matrix3d numeric;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      const Pose2 ahead = move(Pose2::from_vector(pose.vector() + step), with_control(control));
      const Pose2 behind = move(Pose2::from_vector(pose.vector() - step), with_control(control));
      numeric.col(k) = difference(ahead, behind) / (2.0 * kStep);
    }
    EXPECT_LT((move_jacobian_pose(pose, with_control(control)) - numeric).norm(), kTolerance);
  }
}

TEST(Odometry, HasTheJacobianByTheControlOfFiniteDifferences) {
  RandomStream random(2, "odometry");
  for (int i = 0; i < 100; ++i) {
    const auto [pose, control] = draw(random);
    Eigen::Matrix3d numeric;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      const Pose2 ahead = move(pose, with_control(control + step));
      const Pose2 behind = move(pose, with_control(control - step));
      numeric.col(k) = difference(ahead, behind) / (2.0 * kStep);
    }
    EXPECT_LT((move_jacobian_control(pose, with_control(control)) - numeric).norm(), kTolerance);
  }
}

TEST(Odometry, AnArcEndsWhereTheExactUnicycleDoes) {
  const double v = 0.3;
  const double w = -0.7;
  const double t = 2.0;
  const Pose2 end = move({}, arc_increment(v, w, {}, Stamp::from_seconds(t)));
  EXPECT_NEAR(end.x, v / w * std::sin(w * t), 1e-12);
  EXPECT_NEAR(end.y, v / w * (1.0 - std::cos(w * t)), 1e-12);
  EXPECT_NEAR(end.theta, w * t, 1e-12);
}

TEST(Odometry, AnArcHasNoSeamWhereItBecomesStraight) {
  const Stamp end = Stamp::from_seconds(1.0);
  for (const double w : {0.0, 1e-9, 1.9e-6, 2.1e-6}) {
    const OdometryIncrement u = arc_increment(0.3, w, {}, end);
    EXPECT_NEAR(u.trans, 0.3, 1e-12);
    EXPECT_DOUBLE_EQ(u.rot1 + u.rot2, w);
  }
}

TEST(Odometry, SplittingAnIncrementChangesNoVariance) {
  const OdometryNoise noise;
  const OdometryIncrement whole = arc_increment(0.0, 0.4, {}, Stamp::from_seconds(1.0));
  const OdometryIncrement half = arc_increment(0.0, 0.4, {}, Stamp::from_seconds(0.5));
  EXPECT_TRUE(
      (control_covariance(whole, noise) - 2.0 * control_covariance(half, noise)).isZero(1e-18));

  const OdometryIncrement run = with_control({0.0, 2.0, 0.0});
  const OdometryIncrement part = with_control({0.0, 0.5, 0.0});
  EXPECT_TRUE(
      (control_covariance(run, noise) - 4.0 * control_covariance(part, noise)).isZero(1e-18));
}

TEST(Odometry, VariancesGrowWithDistanceAndTurn) {
  const OdometryNoise noise{0.02, 0.003, 0.05};
  const Eigen::Matrix3d covariance = control_covariance(with_control({0.3, -1.5, -0.1}), noise);
  const double rotation = 0.003 * 0.003 * 1.5 + 0.05 * 0.05 * 0.4;
  EXPECT_NEAR(covariance(0, 0) + covariance(2, 2), rotation, 1e-18);
  EXPECT_NEAR(covariance(1, 1), 0.02 * 0.02 * 1.5, 1e-18);
}

TEST(ChordIncrement, BringsOnePoseToTheOther) {
  const Pose2 before{1.0, 2.0, 0.3};
  for (const auto& [v, w] : {std::pair{0.3, 0.5}, {-0.2, 0.4}, {0.3, 0.0}, {0.25, -2.0}}) {
    const auto arc = arc_increment(v, w, Stamp{0}, Stamp::from_seconds(0.4));
    const Pose2 after = move(before, arc);
    const auto chord = chord_increment(before, after, w * 0.4, arc.from, arc.to);
    EXPECT_NEAR(chord.rot1, arc.rot1, 1e-12);
    EXPECT_NEAR(chord.trans, arc.trans, 1e-12);
    EXPECT_NEAR(chord.rot2, arc.rot2, 1e-12);
  }
}

TEST(ChordIncrement, HasNoDirectionOfItsOwnWhenTheBaseTurnsOnTheSpot) {
  const auto u = chord_increment({1.0, 2.0, 0.3}, {1.0, 2.0 + 1e-15, 0.5}, 0.2, Stamp{0}, Stamp{1});
  EXPECT_DOUBLE_EQ(u.rot1, 0.1);
  EXPECT_DOUBLE_EQ(u.rot2, 0.1);
  EXPECT_DOUBLE_EQ(u.trans, 0.0);
}

}  // namespace
}  // namespace vigia
