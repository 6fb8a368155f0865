#include "vigia/core/camera_model.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"

namespace vigia {
namespace {

UnifiedOmni omni(double xi) {
  UnifiedOmni model;
  model.xi = xi;
  model.py = -model.py;  // a mirror's image
  return model;
}

Intrinsics bent_lens() {
  Intrinsics lens;
  lens.py = 690.0;
  lens.kdu = 0.12;
  return lens;
}

class EveryCameraModel : public testing::TestWithParam<CameraModel> {};
INSTANTIATE_TEST_SUITE_P(Models, EveryCameraModel,
                         testing::Values(CameraModel{bent_lens()}, CameraModel{omni(0.0)},
                                         CameraModel{omni(0.6)}, CameraModel{omni(1.0)},
                                         CameraModel{omni(1.4)}));

/// Pixels that show something.
std::vector<Eigen::Vector2d> seen_pixels(const CameraModel& model) {
  std::vector<Eigen::Vector2d> pixels;
  RandomStream random(3, "pixels");
  while (pixels.size() < 200) {
    const Eigen::Vector2d uv(random.uniform(0.0, 639.0), random.uniform(0.0, 479.0));
    const auto direction = ray(model, uv);
    // Away from the mirror's edge, where a finite step would leave the field.
    if (direction && direction->z() > -0.2) pixels.push_back(uv);
  }
  return pixels;
}

TEST_P(EveryCameraModel, ProjectsTheRayOfAPixelBackOntoThePixel) {
  for (const Eigen::Vector2d& uv : seen_pixels(GetParam())) {
    const Eigen::Vector3d direction = *ray(GetParam(), uv);
    EXPECT_NEAR(direction.norm(), 1.0, 1e-14);
    const auto seen = project(GetParam(), 3.0 * direction);
    ASSERT_TRUE(seen);
    EXPECT_LT((*seen - uv).norm(), 1e-9);
  }
}

TEST_P(EveryCameraModel, HasTheJacobianOfFiniteDifferencesOfAPoint) {
  constexpr double kStep = 1e-6;
  for (const Eigen::Vector2d& uv : seen_pixels(GetParam())) {
    const Eigen::Vector3d p_c = 2.0 * *ray(GetParam(), uv);
    Eigen::Matrix<double, 2, 3> numeric;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      numeric.col(k) =
          (*project(GetParam(), p_c + step) - *project(GetParam(), p_c - step)) / (2.0 * kStep);
    }
    const auto exact = project_jacobian(GetParam(), p_c);
    ASSERT_TRUE(exact);
    // Rounding of a pixel (1e-13) over the step, and the third derivative.
    EXPECT_LT((*exact - numeric).norm(), 1e-6 * exact->norm());
  }
}

TEST_P(EveryCameraModel, HasTheJacobianOfFiniteDifferencesOfAPixel) {
  constexpr double kStep = 1e-4;
  for (const Eigen::Vector2d& uv : seen_pixels(GetParam())) {
    Eigen::Matrix<double, 3, 2> numeric;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(k);
      numeric.col(k) = (*ray(GetParam(), uv + step) - *ray(GetParam(), uv - step)) / (2.0 * kStep);
    }
    const auto exact = ray_jacobian(GetParam(), uv);
    ASSERT_TRUE(exact);
    EXPECT_LT((*exact - numeric).norm(), 1e-6 * exact->norm());
  }
}

TEST(UnifiedOmni, WithoutAMirrorIsThePinhole) {
  UnifiedOmni model;
  model.xi = 0.0;
  model.max_angle = from_deg(80.0);
  const Intrinsics pinhole{640, 480, model.px, model.py, model.u0, model.v0, 0.0};
  const Eigen::Vector3d p_c(0.7, -0.4, 1.9);
  EXPECT_LT((*project(CameraModel{model}, p_c) - *project(pinhole, p_c)).norm(), 1e-10);
}

TEST(UnifiedOmni, SeesAPointAsMeiAndRivesWriteIt) {
  const UnifiedOmni model = omni(0.8);
  const Eigen::Vector3d p_c(1.0, 2.0, -0.4);
  const Eigen::Vector3d on_sphere = p_c.normalized();
  const auto seen = project(CameraModel{model}, p_c);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->x(), 319.5 + 230.0 * on_sphere.x() / (on_sphere.z() + 0.8), 1e-10);
  EXPECT_NEAR(seen->y(), 239.5 - 230.0 * on_sphere.y() / (on_sphere.z() + 0.8), 1e-10);
}

TEST(UnifiedOmni, ShowsNothingBeyondTheMirrorsEdge) {
  UnifiedOmni model = omni(1.0);
  model.max_angle = from_deg(100.0);
  const auto at = [&](double degrees) {
    const double angle = from_deg(degrees);
    return project(CameraModel{model}, Eigen::Vector3d(std::sin(angle), 0.0, std::cos(angle)));
  };
  EXPECT_TRUE(at(99.9));
  EXPECT_FALSE(at(100.1));
  EXPECT_TRUE(ray(model, *at(99.9)));
  EXPECT_FALSE(ray(model, *at(99.9) + Eigen::Vector2d(1.0, 0.0)));
  EXPECT_FALSE(project_jacobian(model, -Eigen::Vector3d::UnitZ()));
  EXPECT_FALSE(project(CameraModel{model}, Eigen::Vector3d::Zero()));
}

TEST(UnifiedOmni, ShowsNothingWhereItsImageFoldsOver) {
  UnifiedOmni model = omni(2.0);
  model.max_angle = kPi;
  // From cos θ = −1/ξ on, 120°, the same pixels come again.
  const auto at = [&](double degrees) {
    const double angle = from_deg(degrees);
    return project(CameraModel{model}, Eigen::Vector3d(0.0, std::sin(angle), std::cos(angle)));
  };
  EXPECT_TRUE(at(119.9));
  EXPECT_FALSE(at(120.1));
  EXPECT_FALSE(ray(model, {319.5, 239.5 + 230.0}));
}

TEST(CameraModel, BehindAPinholeThereIsNoImage) {
  const CameraModel model = Intrinsics{};
  EXPECT_FALSE(project(model, Eigen::Vector3d(0.0, 0.0, -1.0)));
  EXPECT_FALSE(project_jacobian(model, Eigen::Vector3d(0.0, 0.0, -1.0)));
}

}  // namespace
}  // namespace vigia
