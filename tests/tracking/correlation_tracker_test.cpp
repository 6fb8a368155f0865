#include "vigia/tracking/correlation_tracker.hpp"

#include "disc_scene.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace vigia::tracking::testing {
namespace {

TEST(CorrelationTracker, TheCentreIsGoodToAHundredthOfAPixelAndTheCovarianceHonest) {
  constexpr int kImages = 200;
  constexpr double kSigmas = 3.5;
  const DiscScene scene;
  RandomStream random(21, "correlation");
  double squares = 0.0;
  double nees = 0.0;
  for (int k = 0; k < kImages; ++k) {
    const Ellipse disc{49.0 + random.uniform(0.0, 1.0), 49.0 + random.uniform(0.0, 1.0), 15.0, 13.0,
                       random.uniform(-1.5, 1.5)};
    const imaging::ImageFrame frame = scene.expose(disc, random);
    imaging::Canvas canvas = canvas_of(frame);
    CorrelationTracker tracker;
    const EllipseFeature feature = tracker.acquire(canvas, prediction_near(disc, 2.0, random));
    ASSERT_EQ(feature.status, FeatureStatus::found);
    const Eigen::Vector3d error(feature.ellipse.u - disc.u, feature.ellipse.v - disc.v,
                                feature.ellipse.a - disc.a);
    squares += error.head<2>().squaredNorm();
    nees += error.dot(feature.covariance.topLeftCorner<3, 3>().inverse() * error);
  }
  EXPECT_LT(std::sqrt(squares / (2.0 * kImages)), 0.010);
  EXPECT_NEAR(nees / (3.0 * kImages), 1.0, 0.1 + kSigmas * std::sqrt(2.0 / (3.0 * kImages)));
}

TEST(CorrelationTracker, TheTemplateFollowsGrowthAndTurning) {
  DiscScene scene;
  scene.width = scene.height = 160;
  RandomStream random(22, "growth");
  CorrelationTracker tracker;
  Ellipse disc{80.0, 80.0, 12.0, 9.0, 0.2};
  const imaging::ImageFrame first = scene.expose(disc, random);
  imaging::Canvas canvas = canvas_of(first);
  ASSERT_EQ(tracker.acquire(canvas, prediction_near(disc, 2.0, random)).status,
            FeatureStatus::found);
  for (int k = 0; k < 25; ++k) {
    disc.a *= 1.03;
    disc.b *= 1.025;
    disc.psi += 0.03;
    disc.u += 0.8;
    const imaging::ImageFrame frame = scene.expose(disc, random);
    canvas.attach(frame);
    const EllipseFeature feature = tracker.track(canvas);
    ASSERT_EQ(feature.status, FeatureStatus::found) << k;
    EXPECT_NEAR(feature.ellipse.u, disc.u, 0.05);
    EXPECT_NEAR(feature.ellipse.a, disc.a, 0.06);
    EXPECT_GT(feature.score, 0.95);
  }
}

TEST(CorrelationTracker, BelowTheAcceptanceThresholdThereIsNoMatch) {
  RandomStream random(23, "acceptance");
  const Ellipse disc{50.0, 50.0, 15.0, 13.0, 0.0};
  SyntheticImage image(100, 100, 200.0);
  image.paint_rectangle(50.0, 50.0, 60.0, 5.0, 0.7, 50.0);
  const imaging::ImageFrame frame(image.expose(4.0, random));
  imaging::Canvas canvas = canvas_of(frame);
  CorrelationTracker tracker;
  const EllipseFeature feature = tracker.acquire(canvas, prediction_near(disc, 1.0, random));
  EXPECT_EQ(feature.status, FeatureStatus::not_found);
  EXPECT_LT(feature.score, 0.6);
}

TEST(CorrelationTracker, TheScoreIgnoresLinearChangesOfGreyValues) {
  RandomStream random(24, "linear");
  const Ellipse disc{50.2, 50.7, 15.0, 13.0, 0.3};
  double scores[2] = {};
  Ellipse ellipses[2];
  for (int k = 0; k < 2; ++k) {
    DiscScene scene;
    scene.noise = 0.0;
    scene.ground = k == 0 ? 200.0 : 120.0;
    scene.contrast = k == 0 ? 150.0 : 75.0;
    const imaging::ImageFrame frame = scene.expose(disc, random);
    imaging::Canvas canvas = canvas_of(frame);
    CorrelationTracker tracker;
    EllipsePrediction prediction;
    prediction.ellipse = disc;
    const EllipseFeature feature = tracker.acquire(canvas, prediction);
    ASSERT_EQ(feature.status, FeatureStatus::found);
    scores[k] = feature.score;
    ellipses[k] = feature.ellipse;
  }
  EXPECT_NEAR(scores[0], scores[1], 1e-3);
  EXPECT_NEAR(ellipses[0].u, ellipses[1].u, 2e-3);
}

TEST(CorrelationTracker, AHiddenPartIsNoticed) {
  RandomStream random(25, "hidden");
  const Ellipse disc{50.0, 50.0, 15.0, 13.0, 0.0};
  CorrelationTracker tracker;
  SyntheticImage image(100, 100, 200.0);
  image.paint_ellipse(disc, 50.0);
  const imaging::ImageFrame first(image.expose(4.0, random));
  imaging::Canvas canvas = canvas_of(first);
  ASSERT_EQ(tracker.acquire(canvas, prediction_near(disc, 1.0, random)).status,
            FeatureStatus::found);
  image.paint_rectangle(34.0, 50.0, 14.0, 60.0, 0.0, 200.0);
  const imaging::ImageFrame second(image.expose(4.0, random));
  canvas.attach(second);
  EXPECT_EQ(tracker.track(canvas).status, FeatureStatus::occluded);
}

}  // namespace
}  // namespace vigia::tracking::testing
