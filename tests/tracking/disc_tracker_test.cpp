#include "vigia/tracking/disc_tracker.hpp"

#include "disc_scene.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace vigia::tracking::testing {
namespace {

const Ellipse kDisc{80.3, 70.6, 15.0, 12.0, 0.4};

// A tracker that has acquired kDisc on plain ground.
class TrackingADisc : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_.width = 200;
    scene_.height = 160;
    const imaging::ImageFrame frame = scene_.expose(kDisc, random_);
    imaging::Canvas canvas = canvas_of(frame);
    ASSERT_EQ(tracker_.acquire(canvas, prediction_near(kDisc, 2.0, random_)).status,
              FeatureStatus::found);
  }

  EllipseFeature track(const SyntheticImage& image) {
    const imaging::ImageFrame frame(image.expose(scene_.noise, random_));
    imaging::Canvas canvas = canvas_of(frame);
    return tracker_.track(canvas);
  }

  SyntheticImage picture(const Ellipse& disc) const {
    SyntheticImage image(scene_.width, scene_.height, scene_.ground);
    image.paint_ellipse(disc, scene_.ground - scene_.contrast);
    return image;
  }

  DiscScene scene_;
  RandomStream random_{11, "tracking a disc"};
  DiscTracker tracker_;
};

TEST_F(TrackingADisc, AMovingDiscIsFollowed) {
  Ellipse disc = kDisc;
  for (int k = 0; k < 40; ++k) {
    disc.u += 1.3;
    disc.v += 0.7 * std::sin(0.3 * k);
    disc.a *= 1.004;
    disc.b *= 1.004;
    const EllipseFeature feature = track(picture(disc));
    ASSERT_EQ(feature.status, FeatureStatus::found) << k;
    EXPECT_NEAR(feature.ellipse.u, disc.u, 0.05);
    EXPECT_NEAR(feature.ellipse.v, disc.v, 0.05);
  }
}

TEST_F(TrackingADisc, AnExpectedJumpOfManyPixelsIsFollowed) {
  Ellipse disc = kDisc;
  disc.u += 60.0;
  disc.v += 40.0;
  tracker_.expect_motion({58.0, 41.0});
  const EllipseFeature feature = track(picture(disc));
  ASSERT_EQ(feature.status, FeatureStatus::found);
  EXPECT_NEAR(feature.ellipse.u, disc.u, 0.05);
}

TEST(DiscTracker, ADiscThatLeavesTheSeedIsFoundInTheWindow) {
  RandomStream random(16, "jump");
  const DiscScene scene;
  Ellipse disc{50.0, 45.0, 7.0, 6.0, 0.0};
  const imaging::ImageFrame first = scene.expose(disc, random);
  imaging::Canvas canvas = canvas_of(first);
  DiscTracker tracker;
  ASSERT_EQ(tracker.acquire(canvas, prediction_near(disc, 1.0, random)).status,
            FeatureStatus::found);
  disc.v += 10.0;  // the old centre lies on the ground now
  const imaging::ImageFrame second = scene.expose(disc, random);
  canvas.attach(second);
  const EllipseFeature feature = tracker.track(canvas);
  ASSERT_EQ(feature.status, FeatureStatus::found);
  EXPECT_NEAR(feature.ellipse.v, disc.v, 0.1);
}

TEST_F(TrackingADisc, AMissingDiscIsNotFoundAndFoundAgain) {
  const SyntheticImage empty(scene_.width, scene_.height, scene_.ground);
  EXPECT_EQ(track(empty).status, FeatureStatus::not_found);
  EXPECT_EQ(track(empty).status, FeatureStatus::not_found);
  EXPECT_EQ(track(picture(kDisc)).status, FeatureStatus::found);
}

TEST_F(TrackingADisc, APartlyHiddenDiscIsOccluded) {
  for (const double level : {20.0, 130.0, 200.0, 240.0})
    for (const double reach : {5.0, 9.0, 14.0}) {
      SyntheticImage image = picture(kDisc);
      image.paint_rectangle(kDisc.u - 25.0 + reach - 12.0, kDisc.v, 50.0, 60.0, 0.0, level);
      const EllipseFeature feature = track(image);
      EXPECT_NE(feature.status, FeatureStatus::found) << level << ' ' << reach;
    }
  SyntheticImage image = picture(kDisc);
  image.paint_rectangle(kDisc.u - 34.0, kDisc.v, 50.0, 60.0, 0.0, 200.0);
  EXPECT_EQ(track(image).status, FeatureStatus::occluded);
}

TEST_F(TrackingADisc, ATinyScratchOnTheOutlineBarelyMovesTheEllipse) {
  SyntheticImage image = picture(kDisc);
  const double edge = kDisc.u + 14.0;
  image.paint_rectangle(edge, kDisc.v + 5.0, 3.0, 3.0, 0.0, 255.0);
  const EllipseFeature feature = track(image);
  ASSERT_EQ(feature.status, FeatureStatus::found);
  EXPECT_NEAR(feature.ellipse.u, kDisc.u, 0.1);
  EXPECT_NEAR(feature.ellipse.v, kDisc.v, 0.1);
}

TEST_F(TrackingADisc, ADiscThatTheBorderCutsIsToldAsSuch) {
  Ellipse disc = kDisc;
  for (const double u : {20.0, 17.0, 14.2, 11.0}) {
    tracker_.expect_motion({u - disc.u, 0.0});
    disc.u = u;
    const EllipseFeature feature = track(picture(disc));
    // The horizontal half extent is 14.6 px.
    if (u < 14.5) {
      EXPECT_EQ(feature.status, FeatureStatus::cut_by_border) << u;
      tracker_.expect_motion({-(u - disc.u), 0.0});
    }
  }
}

TEST_F(TrackingADisc, AnotherThingInItsPlaceIsAWrongObject) {
  SyntheticImage square(scene_.width, scene_.height, scene_.ground);
  square.paint_rectangle(kDisc.u, kDisc.v, 26.0, 26.0, 0.2, 50.0);
  EXPECT_EQ(track(square).status, FeatureStatus::wrong_object);
  const Ellipse huge{kDisc.u, kDisc.v, 23.0, 20.0, 0.0};
  EXPECT_EQ(track(picture(huge)).status, FeatureStatus::wrong_object);
}

TEST_F(TrackingADisc, AFaintDiscHasLowContrast) {
  SyntheticImage image(scene_.width, scene_.height, scene_.ground);
  image.paint_ellipse(kDisc, scene_.ground - 20.0);
  EXPECT_EQ(track(image).status, FeatureStatus::low_contrast);
}

TEST_F(TrackingADisc, AFlatImageIsNoDisc) {
  for (const double level : {0.0, 50.0, 125.0, 200.0, 255.0})
    EXPECT_NE(track(SyntheticImage(scene_.width, scene_.height, level)).status,
              FeatureStatus::found)
        << level;
}

TEST(DiscTracker, AFaintNoisyDiscIsNeverLostInTwoThousandFrames) {
  DiscScene scene;
  scene.contrast = 60.0;
  RandomStream random(12, "faint");
  DiscTracker tracker;
  Ellipse disc{50.0, 50.0, 15.0, 13.0, 0.3};
  const imaging::ImageFrame first = scene.expose(disc, random);
  imaging::Canvas canvas = canvas_of(first);
  ASSERT_EQ(tracker.acquire(canvas, prediction_near(disc, 2.0, random)).status,
            FeatureStatus::found);
  int lost = 0;
  for (int k = 0; k < 2000; ++k) {
    disc.u = 50.0 + 8.0 * std::sin(0.11 * k);
    disc.v = 50.0 + 8.0 * std::sin(0.07 * k + 1.0);
    const imaging::ImageFrame frame = scene.expose(disc, random);
    canvas.attach(frame);
    lost += tracker.track(canvas).status == FeatureStatus::found ? 0 : 1;
  }
  EXPECT_EQ(lost, 0);
}

TEST(DiscTracker, AcquisitionTakesTheDiscOfThePredictedSizeAmongSeveral) {
  RandomStream random(13, "several");
  SyntheticImage image(200, 160, 200.0);
  const Ellipse wanted{100.4, 80.2, 15.0, 13.0, 0.2};
  image.paint_ellipse(wanted, 60.0);
  image.paint_ellipse({70.0, 80.0, 8.0, 8.0, 0.0}, 60.0);
  image.paint_ellipse({140.0, 80.0, 22.0, 20.0, 0.0}, 60.0);
  const imaging::ImageFrame frame(image.expose(4.0, random));
  imaging::Canvas canvas = canvas_of(frame);
  DiscTracker tracker;
  EllipsePrediction prediction;
  prediction.ellipse = {90.0, 84.0, 15.5, 13.0, 0.2};
  prediction.centre_covariance = Eigen::Matrix2d::Identity() * 100.0;
  prediction.scale_sigma = 0.08;
  const EllipseFeature feature = tracker.acquire(canvas, prediction);
  ASSERT_EQ(feature.status, FeatureStatus::found);
  EXPECT_NEAR(feature.ellipse.u, wanted.u, 0.05);
  EXPECT_NEAR(feature.ellipse.a, wanted.a, 0.1);
}

TEST(DiscTracker, AcquisitionComputesOnlyItsWindow) {
  DiscScene scene;
  scene.width = 640;
  scene.height = 480;
  RandomStream random(14, "window");
  const Ellipse disc{320.0, 240.0, 15.0, 13.0, 0.2};
  const imaging::ImageFrame frame = scene.expose(disc, random);
  imaging::Canvas canvas = canvas_of(frame);
  DiscTracker tracker;
  ASSERT_EQ(tracker.acquire(canvas, prediction_near(disc, 3.0, random)).status,
            FeatureStatus::found);
  EXPECT_LT(canvas.computed().width, 110);
  EXPECT_LT(canvas.computed().height, 110);
}

TEST(DiscTracker, AcquisitionOutsideTheFrameFindsNothing) {
  RandomStream random(15, "outside");
  const imaging::ImageFrame frame = DiscScene{}.expose({50.0, 50.0, 15.0, 13.0, 0.0}, random);
  imaging::Canvas canvas = canvas_of(frame);
  DiscTracker tracker;
  EllipsePrediction prediction;
  prediction.ellipse = {500.0, -300.0, 15.0, 13.0, 0.0};
  EXPECT_EQ(tracker.acquire(canvas, prediction).status, FeatureStatus::not_found);
  EXPECT_EQ(tracker.track(canvas).status, FeatureStatus::not_found);
}

TEST(DiscTracker, TheTableKnowsTheThreeTrackersAndNoOther) {
  for (const char* name : {"disc", "ellipse", "correlation"}) {
    const auto tracker = make_ellipse_tracker(name);
    ASSERT_NE(tracker, nullptr);
    EXPECT_EQ(tracker->name(), name);
  }
  EXPECT_EQ(make_ellipse_tracker("dots"), nullptr);
}

}  // namespace
}  // namespace vigia::tracking::testing
