#include "vigia/core/ground.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace vigia
