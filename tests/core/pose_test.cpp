#include "vigia/core/pose.hpp"

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"

namespace vigia {
namespace {

constexpr double kTiny = 1e-12;

TEST(Angle, WrapsIntoMinusPiExclusiveToPiInclusive) {
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(3.0 * kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(0.0), 0.0);
  EXPECT_NEAR(wrap_angle(2.0 * kPi + 0.25), 0.25, kTiny);
  EXPECT_NEAR(wrap_angle(-2.0 * kPi - 0.25), -0.25, kTiny);
}

TEST(Angle, WrappingChangesTheAngleByWholeTurnsOnly) {
  RandomStream random(7, "wrap");
  for (int i = 0; i < 1000; ++i) {
    const double angle = random.uniform(-100.0, 100.0);
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
  }
}

TEST(Angle, DegreesAndRadiansAreInverse) {
  EXPECT_DOUBLE_EQ(from_deg(180.0), kPi);
  EXPECT_DOUBLE_EQ(to_deg(from_deg(37.5)), 37.5);
}

Pose2 random_pose(RandomStream& random) {
  return {random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-3.1, 3.1)};
}

TEST(Pose, CompositionAgreesWithRigidTransforms) {
  RandomStream random(1, "poses");
  for (int i = 0; i < 100; ++i) {
    const Pose2 aMb = random_pose(random);
    const Pose2 bMc = random_pose(random);
    const Eigen::Matrix4d expected = (to_isometry(aMb) * to_isometry(bMc)).matrix();
    EXPECT_TRUE(to_isometry(compose(aMb, bMc)).matrix().isApprox(expected, kTiny));
  }
}

TEST(Pose, APoseComposedWithItsInverseIsTheIdentity) {
  RandomStream random(2, "poses");
  for (int i = 0; i < 100; ++i) {
    const Pose2 aMb = random_pose(random);
    EXPECT_LT(compose(aMb, inverse(aMb)).vector().norm(), kTiny);
    EXPECT_LT(compose(inverse(aMb), aMb).vector().norm(), kTiny);
  }
}

TEST(Pose, CompositionIsAssociative) {
  RandomStream random(3, "poses");
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = random_pose(random);
    const Pose2 b = random_pose(random);
    const Pose2 c = random_pose(random);
    const auto gap = difference(compose(compose(a, b), c), compose(a, compose(b, c)));
    EXPECT_LT(gap.norm(), kTiny);
  }
}

TEST(Pose, DifferenceWrapsTheAngle) {
  const Eigen::Vector3d gap = difference({1.0, 2.0, 3.1}, {0.5, 1.0, -3.1});
  EXPECT_NEAR(gap.x(), 0.5, kTiny);
  EXPECT_NEAR(gap.y(), 1.0, kTiny);
  EXPECT_NEAR(gap.z(), 6.2 - 2.0 * kPi, kTiny);
}

TEST(Pose, AVectorMakesAWrappedPose) {
  const Pose2 pose = Pose2::from_vector({1.0, 2.0, 4.0});
  EXPECT_NEAR(pose.theta, 4.0 - 2.0 * kPi, kTiny);
  EXPECT_EQ(pose.position(), Eigen::Vector2d(1.0, 2.0));
}

TEST(Pose, AnIsometryKeepsTheHeight) {
  const Eigen::Isometry3d wMr = to_isometry({1.0, 2.0, kPi / 2.0}, 0.3);
  const Eigen::Vector3d p_w = wMr * Eigen::Vector3d(1.0, 0.0, 0.0);
  EXPECT_LT((p_w - Eigen::Vector3d(1.0, 3.0, 0.3)).norm(), kTiny);
}

}  // namespace
}  // namespace vigia
