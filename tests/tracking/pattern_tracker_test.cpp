#include "vigia/tracking/pattern_tracker.hpp"

#include "tracking/pattern_views.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"

namespace vigia::tracking::testing {
namespace {

const PatternCode kCode{7, 42, 5};

/// A frontal view in which the smaller dots have a radius of @p dot_px.
PatternView frontal_view(const Landmark& landmark, double dot_px, const Eigen::Vector2d& offset,
                         double angle = 0.0) {
  PatternView view;
  const double distance = 2.5;
  view.intrinsics.px = view.intrinsics.py = dot_px * distance / PatternShape{}.dot_radius_m;
  view.wMc = look_at(landmark, distance, angle, 0.3, 0.2, offset, view.intrinsics);
  return view;
}

PointsPrediction prediction_of(const Landmark& landmark, const PatternView& view, double off) {
  PointsPrediction prediction;
  prediction.landmark = landmark.id;
  for (const PatternDot& dot : pattern_dots(std::get<PatternShape>(landmark.shape)))
    prediction.points.push_back({dot.label,
                                 dot_image(landmark, dot, view) + Eigen::Vector2d(off, -off),
                                 Eigen::Matrix2d::Identity()});
  prediction.covariance *= off * off;
  prediction.scale_sigma = 0.03;
  return prediction;
}

Eigen::Vector2d dot_at(const LandmarkHall& hall, const PatternView& view, std::size_t label) {
  const auto dots = pattern_dots(std::get<PatternShape>(hall.landmark().shape));
  return dot_image(hall.landmark(), dots.at(label), view);
}

/// Paints a square of one colour over a spot.
void paint(vpImage<vpRGBa>& image, const Eigen::Vector2d& spot, int reach, const vpRGBa& colour) {
  for (int v = -reach; v <= reach; ++v)
    for (int u = -reach; u <= reach; ++u)
      image[static_cast<unsigned>(std::lround(spot.y()) + v)][std::lround(spot.x()) + u] = colour;
}

/// A hall with a pattern, a view and a tracker that knows the map.
struct PatternTracking : ::testing::Test {
  LandmarkHall hall{pattern_of(kCode)};
  PatternView view = frontal_view(hall.landmark(), 12.0, {3.0, -2.0}, from_deg(30.0));
  PatternTracker tracker{KnownCodes{false, hall.world().landmarks}};

  vpImage<vpRGBa> picture(std::int64_t stamp = 0) const {
    return hall.picture(view.wMc, view.intrinsics, colour_params(), stamp);
  }
  PointsFeature acquire(const vpImage<vpRGBa>& image) {
    return tracker.acquire(imaging::ImageFrame(image), prediction_of(hall.landmark(), view, 4.0));
  }
};

TEST_F(PatternTracking, ReadsTheCodeTheLandmarkAndAllItsPoints) {
  const PointsFeature feature = acquire(picture());
  ASSERT_EQ(feature.status, FeatureStatus::found);
  EXPECT_EQ(feature.landmark, 1);
  EXPECT_EQ(std::get<PatternCode>(*feature.code), kCode);
  EXPECT_GT(feature.confidence, 0.9999);
  ASSERT_EQ(feature.points.size(), 17U);
  for (std::size_t i = 0; i < 17; ++i) {
    EXPECT_EQ(feature.points[i].label, static_cast<int>(i));
    EXPECT_LE((feature.points[i].uv - dot_at(hall, view, i)).norm(), 0.05);
  }
}

TEST_F(PatternTracking, AWindowGivesWhatTheFullFrameGives) {
  const auto image = picture();
  const PointsFeature windowed = acquire(image);
  const auto all = PatternTracker(KnownCodes{false, hall.world().landmarks})
                       .find_all(imaging::ImageFrame(image));
  ASSERT_EQ(all.size(), 1U);
  ASSERT_EQ(windowed.points.size(), all[0].points.size());
  for (std::size_t i = 0; i < windowed.points.size(); ++i)
    EXPECT_LE((windowed.points[i].uv - all[0].points[i].uv).norm(), 1e-9);
}

TEST_F(PatternTracking, FollowsAMovingPatternAndReadsOnlyWhatItNeeds) {
  ASSERT_EQ(acquire(picture()).status, FeatureStatus::found);
  for (int k = 1; k <= 12; ++k) {
    view = frontal_view(hall.landmark(), 12.0 + 0.1 * k, {3.0 + 4.0 * k, -2.0 - 3.0 * k},
                        from_deg(30.0 + k));
    const auto frame = hall.scene().expose(view.wMc, view.intrinsics, {k}, colour_params());
    const PointsFeature feature = tracker.track(*frame);
    ASSERT_EQ(feature.status, FeatureStatus::found) << "frame " << k;
    EXPECT_EQ(feature.landmark, 1);
    EXPECT_EQ(feature.points.size(), 17U);
    for (const LabelledPoint& point : feature.points)
      EXPECT_LE((point.uv - dot_at(hall, view, static_cast<std::size_t>(point.label))).norm(),
                0.05);
  }
}

TEST_F(PatternTracking, ALargeJumpIsFollowedWhenItIsForetold) {
  ASSERT_EQ(acquire(picture()).status, FeatureStatus::found);
  view = frontal_view(hall.landmark(), 12.0, {63.0, 38.0}, from_deg(30.0));
  tracker.expect_motion({60.0, 40.0});
  const PointsFeature feature = tracker.track(imaging::ImageFrame(picture()));
  EXPECT_EQ(feature.status, FeatureStatus::found);
}

TEST_F(PatternTracking, ADotHiddenInOneRingIsLeftOutAndTheOtherRingIsRead) {
  auto image = picture();
  paint(image, dot_at(hall, view, 3), 12, vpRGBa(150, 140, 120));
  paint(image, dot_at(hall, view, 14), 12, vpRGBa(30, 30, 90));
  const PointsFeature feature = acquire(image);
  ASSERT_EQ(feature.status, FeatureStatus::found);
  EXPECT_EQ(std::get<PatternCode>(*feature.code), kCode);
  EXPECT_EQ(feature.points.size(), 15U);
  for (const LabelledPoint& point : feature.points)
    EXPECT_TRUE(point.label != 3 && point.label != 14);
}

TEST_F(PatternTracking, OnePlaceHiddenInBothRingsIsOccluded) {
  auto image = picture();
  paint(image, dot_at(hall, view, 3), 12, vpRGBa(210, 210, 210));
  paint(image, dot_at(hall, view, 11), 12, vpRGBa(210, 210, 210));
  const PointsFeature feature = acquire(image);
  EXPECT_EQ(feature.status, FeatureStatus::occluded);
  EXPECT_FALSE(feature.code);
}

TEST_F(PatternTracking, APatternThatIsHiddenWhileItIsTrackedIsOccludedAndFoundAgain) {
  ASSERT_EQ(acquire(picture()).status, FeatureStatus::found);
  auto image = picture(1);
  for (const std::size_t label : {0U, 1U, 2U, 3U, 9U, 10U, 11U})
    paint(image, dot_at(hall, view, label), 25, vpRGBa(90, 90, 90));
  EXPECT_EQ(tracker.track(imaging::ImageFrame(image)).status, FeatureStatus::occluded);
  EXPECT_EQ(tracker.track(imaging::ImageFrame(picture(2))).status, FeatureStatus::found);
}

TEST_F(PatternTracking, ADotThatChangesItsColourIsDoubtful) {
  auto image = picture();
  // Both dots of place 2 in purple, as large as they were.
  for (const std::size_t label : {2U, 10U}) {
    const Eigen::Vector2d spot = dot_at(hall, view, label);
    for (int v = -16; v <= 16; ++v)
      for (int u = -16; u <= 16; ++u) {
        vpRGBa& p =
            image[static_cast<unsigned>(std::lround(spot.y()) + v)][std::lround(spot.x()) + u];
        const double paper = std::min(1.0, (p.R + p.G + p.B) / 630.0 * 1.4 - 0.4);
        p = vpRGBa(static_cast<unsigned char>(150 + 60 * paper),
                   static_cast<unsigned char>(40 + 170 * std::max(0.0, paper)),
                   static_cast<unsigned char>(145 + 65 * paper));
      }
  }
  const PointsFeature feature = acquire(image);
  EXPECT_EQ(feature.status, FeatureStatus::unreadable);
  EXPECT_FALSE(feature.code);
}

TEST_F(PatternTracking, ACodeThatIsNotInTheMapIsSaidToBeUnknown) {
  const LandmarkHall other(pattern_of({7, 42, 6}));
  const PointsFeature feature = acquire(other.picture(view.wMc, view.intrinsics, colour_params()));
  EXPECT_EQ(feature.status, FeatureStatus::unknown_code);
  EXPECT_FALSE(feature.landmark);
  EXPECT_EQ(std::get<PatternCode>(*feature.code), (PatternCode{7, 42, 6}));
}

TEST_F(PatternTracking, AnotherPatternOfTheMapIsAWrongObject) {
  PointsPrediction prediction = prediction_of(hall.landmark(), view, 4.0);
  prediction.landmark = 2;
  const PointsFeature feature = tracker.acquire(imaging::ImageFrame(picture()), prediction);
  EXPECT_EQ(feature.status, FeatureStatus::wrong_object);
  EXPECT_EQ(feature.landmark, 1);
  EXPECT_EQ(tracker.track(imaging::ImageFrame(picture())).status, FeatureStatus::not_found);
}

TEST_F(PatternTracking, TheInnerRingIsReadWhereTheOuterLeavesTheImage) {
  // Inner ring 200 px from the centre, outer 314.
  view = frontal_view(hall.landmark(), 33.0, {0.0, 0.0});
  const PointsFeature feature = acquire(picture());
  ASSERT_EQ(feature.status, FeatureStatus::found);
  for (int label = 9; label <= 16; ++label)
    EXPECT_TRUE(std::any_of(feature.points.begin(), feature.points.end(),
                            [&](const auto& point) { return point.label == label; }));
  EXPECT_LT(feature.points.size(), 17U);
}

TEST_F(PatternTracking, APatternAtTheBorderIsCut) {
  view = frontal_view(hall.landmark(), 12.0, {-270.0, 0.0});
  EXPECT_EQ(acquire(picture()).status, FeatureStatus::cut_by_border);
}

TEST_F(PatternTracking, WithoutAPatternThereIsNothing) {
  const LandmarkHall empty(DiscShape{0.05}, "clutter_per_m2: 3");
  const PointsFeature feature = acquire(empty.picture(view.wMc, view.intrinsics, colour_params()));
  EXPECT_EQ(feature.status, FeatureStatus::not_found);
  EXPECT_TRUE(feature.points.empty());
}

TEST(PatternGeometry, OfAnotherSizeIsKnownFromTheMap) {
  PatternShape shape = pattern_of(kCode);
  shape.outer_radius_m = 0.13;
  shape.inner_radius_m = 0.075;
  shape.dot_radius_m = 0.014;
  const LandmarkHall hall(shape);
  const PatternView view = frontal_view(hall.landmark(), 11.0, {0.0, 0.0}, from_deg(40.0));
  const imaging::ImageFrame frame(hall.picture(view.wMc, view.intrinsics, colour_params()));
  const auto found = PatternTracker(KnownCodes{false, hall.world().landmarks}).find_all(frame);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].status, FeatureStatus::found);
  EXPECT_EQ(found[0].landmark, 1);
}

// The bound of a dot's centre (LIBRARIES: (σ/C)·√(2 s_b/(√π r)) per axis) with the contrast that
// the three channels have together.
TEST(PatternAccuracy, CentresReachTheBoundAndKnowTheirErrors) {
  constexpr int kFrames = 40;
  constexpr double kRadius = 12.0;
  constexpr double kNoise = 8.0;
  const LandmarkHall hall(pattern_of(kCode), "contrast: 0, clutter_per_m2: 0");
  const auto dots = pattern_dots(pattern_of(kCode));
  const double reflectance[4][3] = {
      {0.12, 0.12, 0.12}, {0.80, 0.14, 0.16}, {0.12, 0.55, 0.25}, {0.14, 0.22, 0.72}};
  RandomStream random(4, "accuracy");
  double ratio = 0.0;
  double nees = 0.0;
  int count = 0;
  for (int k = 0; k < kFrames; ++k) {
    const PatternView view = frontal_view(hall.landmark(), kRadius,
                                          {random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0)});
    const imaging::ImageFrame frame(
        hall.picture(view.wMc, view.intrinsics, colour_params(kNoise), k));
    const auto found = make_point_tracker("pattern", {})->find_all(frame);
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(found[0].points.size(), 17U);
    for (const LabelledPoint& point : found[0].points) {
      const PatternDot& dot = dots[static_cast<std::size_t>(point.label)];
      double square = 0.0;
      for (const double share : reflectance[static_cast<int>(dot.colour)])
        square += std::pow(210.0 * (1.0 - share), 2);
      const double s_b = std::sqrt(0.7 * 0.7 + 1.0 / 12.0);
      const double radius = kRadius * dot.radius_m / PatternShape{}.dot_radius_m;
      const double bound = std::sqrt((kNoise * kNoise + 1.0 / 12.0) / square * 2.0 * s_b /
                                     (std::sqrt(kPi) * radius));
      const Eigen::Vector2d error = point.uv - dot_image(hall.landmark(), dot, view);
      ratio += error.squaredNorm() / (bound * bound);
      nees += error.dot(point.covariance.inverse() * error);
      count += 2;
    }
  }
  ratio /= count;
  nees /= count;
  std::printf("rms over bound %.3f, NEES per axis %.3f, %d values\n", std::sqrt(ratio), nees,
              count);
  // 1360 squares of unit normals: standard error of the mean 0.038; three of them, and 5 % of the
  // bound for the covariance and the rounding of the mixture.
  EXPECT_LE(std::sqrt(ratio), 1.05 + 3.0 * 0.5 * 0.038);
  EXPECT_NEAR(nees, 1.0, 0.05 + 3.0 * 0.038);
}

TEST(PatternReading, CleanViewsAreReadAndNeverWrongly) {
  const ReadingRates rates = read_clean_views(100, 21);
  EXPECT_EQ(rates.wrong, 0);
  EXPECT_GE(rates.right, 99);
}

TEST(PatternReading, HardViewsAreRejectedRatherThanReadWrongly) {
  const ReadingRates rates = read_hard_views(100, 22);
  std::printf("%d of %d hard views read\n", rates.right, rates.views);
  EXPECT_EQ(rates.wrong, 0);
  EXPECT_GE(rates.right, 70);
}

}  // namespace
}  // namespace vigia::tracking::testing
