#include "vigia/core/head.hpp"

#include <gtest/gtest.h>

#include "vigia/core/pose.hpp"
#include "vigia/core/random.hpp"

namespace vigia {
namespace {

HeadGeometry offset_head() {
  HeadGeometry geometry;
  geometry.mount_r = {0.15, 0.03, 1.0};
  geometry.mount_yaw = 0.2;
  geometry.camera_offset_h = {0.06, 0.02, 0.04};
  return geometry;
}

HeadAngles random_angles(RandomStream& random) {
  return {random.uniform(-3.0, 3.0), random.uniform(-1.2, 1.2)};
}

/// Twist (v, ω) of the second of two neighbouring frames in the first, over a step of @p h.
Eigen::Matrix<double, 6, 1> twist_between(const Eigen::Isometry3d& before,
                                          const Eigen::Isometry3d& after,
                                          const Eigen::Isometry3d& now, double h) {
  const Eigen::Matrix3d cRr = now.linear().transpose();
  const Eigen::Matrix3d spin = cRr * (after.linear() - before.linear()) / h;
  Eigen::Matrix<double, 6, 1> twist;
  twist << cRr * (after.translation() - before.translation()) / h, spin(2, 1), spin(0, 2),
      spin(1, 0);
  return twist;
}

TEST(Head, AtRestLooksForwardWithImageAxesRightAndDown) {
  const Eigen::Isometry3d rMc = camera_in_base({}, {});
  EXPECT_LT((rMc.linear().col(2) - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_LT((rMc.linear().col(0) + Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((rMc.linear().col(1) + Eigen::Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_LT((rMc.translation() - Eigen::Vector3d(0.15, 0.0, 1.0)).norm(), 1e-15);
}

TEST(Head, PansToTheLeftAndTiltsUpForPositiveAngles) {
  EXPECT_GT(camera_in_base({}, {0.3, 0.0}).linear().col(2).y(), 0.0);
  EXPECT_GT(camera_in_base({}, {0.0, 0.3}).linear().col(2).z(), 0.0);
}

TEST(Head, HasTheJacobianOfFiniteDifferences) {
  constexpr double kStep = 1e-5;
  const HeadGeometry geometry = offset_head();
  RandomStream random(5, "head");
  for (int i = 0; i < 50; ++i) {
    const HeadAngles q = random_angles(random);
    const Eigen::Isometry3d rMc = camera_in_base(geometry, q);
    const auto jacobian = camera_jacobian_head(geometry, q);
    const auto by_pan =
        twist_between(camera_in_base(geometry, {q.pan - kStep, q.tilt}),
                      camera_in_base(geometry, {q.pan + kStep, q.tilt}), rMc, 2.0 * kStep);
    const auto by_tilt =
        twist_between(camera_in_base(geometry, {q.pan, q.tilt - kStep}),
                      camera_in_base(geometry, {q.pan, q.tilt + kStep}), rMc, 2.0 * kStep);
    // Truncation is of the order of kStep² = 1e-10, rounding 1e-16/kStep = 1e-11.
    EXPECT_LT((jacobian.col(0) - by_pan).norm(), 1e-9);
    EXPECT_LT((jacobian.col(1) - by_tilt).norm(), 1e-9);
  }
}

TEST(Head, FollowsTheBaseByTheJacobianOfFiniteDifferences) {
  constexpr double kStep = 1e-5;
  const HeadGeometry geometry = offset_head();
  RandomStream random(6, "head");
  for (int i = 0; i < 50; ++i) {
    const HeadAngles q = random_angles(random);
    const Eigen::Isometry3d rMc = camera_in_base(geometry, q);
    const auto jacobian = camera_jacobian_base(geometry, q);
    const auto by_speed = twist_between(to_isometry({-kStep, 0.0, 0.0}) * rMc,
                                        to_isometry({kStep, 0.0, 0.0}) * rMc, rMc, 2.0 * kStep);
    const auto sideways = twist_between(to_isometry({0.0, -kStep, 0.0}) * rMc,
                                        to_isometry({0.0, kStep, 0.0}) * rMc, rMc, 2.0 * kStep);
    EXPECT_LT((camera_twist_sideways(rMc) - sideways).norm(), 1e-8);
    const auto by_turn = twist_between(to_isometry({0.0, 0.0, -kStep}) * rMc,
                                       to_isometry({0.0, 0.0, kStep}) * rMc, rMc, 2.0 * kStep);
    EXPECT_LT((jacobian.col(0) - by_speed).norm(), 1e-9);
    EXPECT_LT((jacobian.col(1) - by_turn).norm(), 1e-9);
  }
}

/// How far the optical axis passes from a point, as an angle.
double aiming_error(const HeadGeometry& geometry, const Eigen::Vector3d& p_r) {
  const Eigen::Isometry3d rMc = camera_in_base(geometry, aim_at(geometry, p_r));
  const Eigen::Vector3d p_c = rMc.inverse() * p_r;
  return std::atan2(p_c.head<2>().norm(), p_c.z());
}

TEST(Head, AimsItsAxisThroughAPoint) {
  HeadGeometry geometry;
  geometry.mount_yaw = -0.4;
  geometry.camera_offset_h.x() = 0.05;
  RandomStream random(8, "aim");
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p_r(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0),
                              random.uniform(0.5, 2.5));
    EXPECT_LT(aiming_error(geometry, p_r), 1e-12) << p_r.transpose();
  }
}

TEST(Head, CompensatesALateralOffsetWhenItAims) {
  RandomStream random(9, "aim");
  for (int i = 0; i < 100; ++i) {
    const double bearing = random.uniform(-3.1, 3.1);
    const double range = random.uniform(2.0, 8.0);
    const Eigen::Vector3d p_r(range * std::cos(bearing), range * std::sin(bearing),
                              random.uniform(0.5, 2.5));
    // An offset of d = 4.5 cm over R ≥ 1.8 m, iterated three times, errs by about (d/R)³.
    EXPECT_LT(aiming_error(offset_head(), p_r), 2e-5) << p_r.transpose();
  }
}

}  // namespace
}  // namespace vigia
