#include "vigia/tracking/moving_edge_tracker.hpp"

#include "disc_scene.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace vigia::tracking::testing {
namespace {

TEST(MovingEdgeTracker, ADiscIsFollowedWithinTheStatedBias) {
  DiscScene scene;
  scene.width = scene.height = 160;
  RandomStream random(31, "moving edges");
  MovingEdgeTracker tracker;
  Ellipse disc{70.0, 70.0, 25.0, 20.0, 0.4};
  const imaging::ImageFrame first = scene.expose(disc, random);
  imaging::Canvas canvas = canvas_of(first);
  ASSERT_EQ(tracker.acquire(canvas, prediction_near(disc, 2.0, random)).status,
            FeatureStatus::found);
  double centre_squares = 0.0;
  double axis_squares = 0.0;
  constexpr int kFrames = 60;
  for (int k = 0; k < kFrames; ++k) {
    disc.u += 0.37;
    disc.v += 0.21;
    const imaging::ImageFrame frame = scene.expose(disc, random);
    canvas.attach(frame);
    const EllipseFeature feature = tracker.track(canvas);
    ASSERT_EQ(feature.status, FeatureStatus::found) << k;
    centre_squares +=
        std::pow(feature.ellipse.u - disc.u, 2) + std::pow(feature.ellipse.v - disc.v, 2);
    axis_squares +=
        std::pow(feature.ellipse.a - disc.a, 2) + std::pow(feature.ellipse.b - disc.b, 2);
  }
  const MovingEdgeTrackerParameters parameters;
  EXPECT_LT(std::sqrt(centre_squares / (2.0 * kFrames)), 1.2 * parameters.centre_bias_px);
  EXPECT_LT(std::sqrt(axis_squares / (2.0 * kFrames)), 1.5 * parameters.axis_bias_px);
}

TEST(MovingEdgeTracker, CentresHaveNoCommonBiasFromStartsBesideThem) {
  RandomStream random(34, "beside");
  for (const double offset : {-2.0, 0.0, 2.0}) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    constexpr int kPictures = 40;
    for (int k = 0; k < kPictures; ++k) {
      const Ellipse disc{49.0 + random.uniform(0.0, 1.0), 49.0 + random.uniform(0.0, 1.0), 15.0,
                         14.0, random.uniform(-1.5, 1.5)};
      const imaging::ImageFrame frame = DiscScene{}.expose(disc, random);
      imaging::Canvas canvas = canvas_of(frame);
      MovingEdgeTracker tracker;
      tracker.start(canvas, {disc.u + offset, disc.v, disc.a, disc.b, disc.psi});
      const EllipseFeature feature = tracker.track(canvas);
      ASSERT_EQ(feature.status, FeatureStatus::found) << offset;
      mean += Eigen::Vector2d(feature.ellipse.u - disc.u, feature.ellipse.v - disc.v) / kPictures;
    }
    EXPECT_LT(mean.norm(), 0.2) << offset;
  }
}

TEST(MovingEdgeTracker, AMissingDiscIsALossAndNoException) {
  RandomStream random(32, "missing");
  const Ellipse disc{50.0, 50.0, 18.0, 15.0, 0.0};
  MovingEdgeTracker tracker;
  const imaging::ImageFrame first = DiscScene{}.expose(disc, random);
  imaging::Canvas canvas = canvas_of(first);
  ASSERT_EQ(tracker.acquire(canvas, prediction_near(disc, 1.0, random)).status,
            FeatureStatus::found);
  const imaging::ImageFrame empty(SyntheticImage(100, 100, 200.0).expose(4.0, random));
  canvas.attach(empty);
  EXPECT_NE(tracker.track(canvas).status, FeatureStatus::found);
}

TEST(MovingEdgeTracker, NothingIsPrintedWhenTheDiscGoes) {
  RandomStream random(33, "quiet");
  const Ellipse disc{50.0, 50.0, 18.0, 15.0, 0.0};
  MovingEdgeTracker tracker;
  const imaging::ImageFrame first = DiscScene{}.expose(disc, random);
  imaging::Canvas canvas = canvas_of(first);
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  tracker.acquire(canvas, prediction_near(disc, 1.0, random));
  const imaging::ImageFrame empty(SyntheticImage(100, 100, 200.0).expose(0.0, random));
  canvas.attach(empty);
  tracker.track(canvas);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(MovingEdgeTracker, AnArcIsRefusedUnlessItIsAskedFor) {
  RandomStream random(34, "arc");
  SyntheticImage image(160, 160, 200.0);
  image.paint_ellipse({135.0, 80.0, 50.0, 35.0, 0.2}, 60.0);
  const imaging::ImageFrame frame(image.expose(2.0, random));
  imaging::Canvas canvas = canvas_of(frame);
  EXPECT_TRUE(MovingEdgeTracker().find_all(canvas).empty());
  MovingEdgeTrackerParameters parameters;
  parameters.min_visible = 0.4;
  const auto features = MovingEdgeTracker(parameters).find_all(canvas);
  ASSERT_EQ(features.size(), 1U);
  EXPECT_NEAR(features[0].ellipse.u, 135.0, 3.0);
  EXPECT_NEAR(features[0].ellipse.a, 50.0, 3.0);
}

}  // namespace
}  // namespace vigia::tracking::testing
