#include "vigia/core/camera.hpp"

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"

namespace vigia {
namespace {

Intrinsics camera_with(double kdu) {
  Intrinsics intrinsics;
  intrinsics.py = 690.0;
  intrinsics.kdu = kdu;
  return intrinsics;
}

class CameraWithDistortion : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Coefficients, CameraWithDistortion,
                         testing::Values(0.0, 0.12, -0.12, 1e-9, -0.35));

TEST_P(CameraWithDistortion, ProjectsTheRayOfAPixelBackOntoThePixel) {
  const Intrinsics intrinsics = camera_with(GetParam());
  for (double u = -40.0; u <= 700.0; u += 37.0) {
    for (double v = -40.0; v <= 520.0; v += 41.0) {
      const Eigen::Vector2d uv(u, v);
      const Eigen::Vector2d xy = unproject(intrinsics, uv);
      const auto seen = project(intrinsics, Eigen::Vector3d(3.0 * xy.x(), 3.0 * xy.y(), 3.0));
      ASSERT_TRUE(seen.has_value());
      EXPECT_LT((*seen - uv).norm(), 1e-9);
    }
  }
}

TEST_P(CameraWithDistortion, HasTheJacobianOfFiniteDifferences) {
  const Intrinsics intrinsics = camera_with(GetParam());
  RandomStream random(11, "pixels");
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d uv(random.uniform(0.0, 639.0), random.uniform(0.0, 479.0));
    const Eigen::Vector2d xy = unproject(intrinsics, uv);
    Eigen::Matrix2d numeric;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(k);
      numeric.col(k) =
          (*distort(intrinsics, xy + step) - *distort(intrinsics, xy - step)) / (2.0 * kStep);
    }
    // Rounding of a pixel (1e-13) over the step leaves 1e-7 of 700.
    EXPECT_LT((distort_jacobian(intrinsics, uv) - numeric).norm(), 1e-4);
  }
}

TEST(Camera, ProjectsByTheFormulaOfViSP) {
  // Undistorted (x, y) = (1 + kdu r_d²)(x_d, y_d), taken literally at one pixel.
  const Intrinsics intrinsics = camera_with(0.2);
  const Eigen::Vector2d d((400.0 - 319.5) / 700.0, (100.0 - 239.5) / 690.0);
  const Eigen::Vector2d xy = unproject(intrinsics, {400.0, 100.0});
  EXPECT_LT((xy - (1.0 + 0.2 * d.squaredNorm()) * d).norm(), 1e-15);
}

TEST(Camera, SeesNothingBehindIt) {
  EXPECT_FALSE(project(Intrinsics{}, {0.1, 0.1, -1.0}));
  EXPECT_FALSE(project(Intrinsics{}, {0.1, 0.1, 0.0}));
}

TEST(Camera, SeesNothingBeyondTheFoldOfItsDistortion) {
  const Intrinsics intrinsics = camera_with(-0.35);
  // The fold: r_d = 1/√(3·0.35) = 0.976 maps to r = 0.6506.
  EXPECT_TRUE(project(intrinsics, {0.650, 0.0, 1.0}));
  EXPECT_FALSE(project(intrinsics, {0.651, 0.0, 1.0}));
}

TEST(Camera, KnowsWhatLiesInItsImage) {
  const Intrinsics intrinsics;
  EXPECT_TRUE(in_image(intrinsics, {0.0, 0.0}));
  EXPECT_TRUE(in_image(intrinsics, {639.0, 479.0}));
  EXPECT_FALSE(in_image(intrinsics, {639.1, 100.0}));
  EXPECT_FALSE(in_image(intrinsics, {4.0, 100.0}, 5.0));
}

ZoomCalibration three_samples() {
  return {640, 480, 320.0, 240.0, {{8.0, 700.0, 0.1}, {20.0, 1800.0, 0.05}, {48.0, 4200.0, 0.0}}};
}

TEST(ZoomCalibration, IsLinearBetweenItsSamples) {
  const Intrinsics at14 = three_samples().at(14.0);
  EXPECT_DOUBLE_EQ(at14.px, 1250.0);
  EXPECT_DOUBLE_EQ(at14.py, 1250.0);
  EXPECT_DOUBLE_EQ(at14.kdu, 0.075);
  EXPECT_DOUBLE_EQ(at14.u0, 320.0);
}

TEST(ZoomCalibration, ClampsToItsRange) {
  const ZoomCalibration zoom = three_samples();
  EXPECT_DOUBLE_EQ(zoom.at(1.0).px, 700.0);
  EXPECT_DOUBLE_EQ(zoom.at(100.0).px, 4200.0);
  EXPECT_DOUBLE_EQ(zoom.zoom_for_focal(100.0), 8.0);
  EXPECT_DOUBLE_EQ(zoom.zoom_for_focal(9000.0), 48.0);
}

TEST(ZoomCalibration, FindsTheZoomOfAFocalLength) {
  const ZoomCalibration zoom = three_samples();
  for (double zoom_mm = 8.0; zoom_mm <= 48.0; zoom_mm += 0.5)
    EXPECT_NEAR(zoom.zoom_for_focal(zoom.at(zoom_mm).px), zoom_mm, 1e-12);
}

TEST(ZoomCalibration, OfOneSampleIsALensThatDoesNotZoom) {
  const ZoomCalibration lens(640, 480, 320.0, 240.0, {{8.0, 700.0, 0.1}});
  EXPECT_DOUBLE_EQ(lens.at(100.0).px, 700.0);
  EXPECT_DOUBLE_EQ(lens.at(1.0).kdu, 0.1);
  EXPECT_DOUBLE_EQ(lens.at(8.0).u0, 320.0);
  EXPECT_DOUBLE_EQ(lens.zoom_for_focal(9000.0), 8.0);
}

TEST(ZoomCalibration, RejectsSamplesThatDoNotIncrease) {
  EXPECT_THROW(ZoomCalibration(640, 480, 320.0, 240.0, {}), std::invalid_argument);
  EXPECT_THROW(ZoomCalibration(640, 480, 320.0, 240.0, {{8.0, 700.0, 0.0}, {9.0, 700.0, 0.0}}),
               std::invalid_argument);
  EXPECT_THROW(ZoomCalibration(640, 480, 320.0, 240.0, {{8.0, 700.0, 0.0}, {8.0, 800.0, 0.0}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace vigia
