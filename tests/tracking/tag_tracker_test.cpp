#include "vigia/tracking/tag_tracker.hpp"

#include "side_fit.hpp"
#include "tracking/pattern_views.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"

namespace vigia::tracking::testing {
namespace {

constexpr double kSide = 0.2;

PatternView view_of(const Landmark& landmark, double side_px, const Eigen::Vector2d& offset,
                    double angle, double roll) {
  PatternView view;
  const double distance = 2.0;
  view.intrinsics.px = view.intrinsics.py = side_px * distance / kSide;
  view.wMc = look_at(landmark, distance, angle, 0.4, roll, offset, view.intrinsics);
  return view;
}

/// The corners in the order of their labels.
std::vector<Eigen::Vector2d> corners_of(const Landmark& landmark, const PatternView& view) {
  const double h = 0.5 * kSide;
  const Eigen::Isometry3d cMl = view.wMc.inverse(Eigen::Isometry) * landmark.wMl;
  std::vector<Eigen::Vector2d> corners;
  for (const auto& [x, y] : {std::pair{-h, -h}, {h, -h}, {h, h}, {-h, h}})
    corners.push_back(*project(view.intrinsics, cMl * Eigen::Vector3d(x, y, 0.0)));
  return corners;
}

struct TagTracking : ::testing::Test {
  LandmarkHall hall{TagShape{17, kSide}};
  TagTracker tracker{KnownCodes{false, hall.world().landmarks}};

  std::unique_ptr<imaging::Frame> expose(const PatternView& view, std::int64_t stamp = 0) const {
    sim::ImagingParams params;
    return hall.scene().expose(view.wMc, view.intrinsics, {stamp}, params);
  }
  PointsPrediction prediction(const PatternView& view) const {
    PointsPrediction result;
    result.landmark = 1;
    int label = 0;
    for (const Eigen::Vector2d& corner : corners_of(hall.landmark(), view))
      result.points.push_back(
          {label++, corner + Eigen::Vector2d(5.0, -4.0), Eigen::Matrix2d::Identity()});
    result.covariance *= 16.0;
    return result;
  }
};

TEST_F(TagTracking, FindsTheTagWithItsCornersInTheReadersOrder) {
  for (const double roll : {0.0, 0.5, -1.2}) {
    const PatternView view = view_of(hall.landmark(), 70.0, {30.0, 20.0}, from_deg(35.0), roll);
    const PointsFeature feature = tracker.acquire(*expose(view), prediction(view));
    ASSERT_EQ(feature.status, FeatureStatus::found);
    EXPECT_EQ(feature.landmark, 1);
    EXPECT_EQ(std::get<int>(*feature.code), 17);
    const auto truth = corners_of(hall.landmark(), view);
    ASSERT_EQ(feature.points.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(feature.points[i].label, static_cast<int>(i));
      EXPECT_LE((feature.points[i].uv - truth[i]).norm(), 0.15) << "roll " << roll;
    }
  }
}

TEST_F(TagTracking, FollowsAMovingTag) {
  PatternView view = view_of(hall.landmark(), 60.0, {0.0, 0.0}, 0.3, 0.1);
  ASSERT_EQ(tracker.acquire(*expose(view), prediction(view)).status, FeatureStatus::found);
  for (int k = 1; k <= 8; ++k) {
    view = view_of(hall.landmark(), 60.0 + k, {9.0 * k, -7.0 * k}, 0.3, 0.1 + 0.05 * k);
    const PointsFeature feature = tracker.track(*expose(view, k));
    ASSERT_EQ(feature.status, FeatureStatus::found) << "frame " << k;
    EXPECT_LE((feature.points[2].uv - corners_of(hall.landmark(), view)[2]).norm(), 0.15);
  }
}

TEST_F(TagTracking, ATagThatIsNotInTheMapIsUnknownAndAnotherOneWrong) {
  const PatternView view = view_of(hall.landmark(), 70.0, {0.0, 0.0}, 0.3, 0.1);
  const LandmarkHall other(TagShape{18, kSide});
  const auto frame = other.scene().expose(view.wMc, view.intrinsics, {}, sim::ImagingParams{});
  EXPECT_EQ(tracker.acquire(*frame, prediction(view)).status, FeatureStatus::unknown_code);
  PointsPrediction wanted = prediction(view);
  wanted.landmark = 2;
  EXPECT_EQ(tracker.acquire(*expose(view), wanted).status, FeatureStatus::wrong_object);
}

TEST_F(TagTracking, ATagAtTheBorderIsCutAndAnEmptyWallShowsNothing) {
  const PatternView cut = view_of(hall.landmark(), 90.0, {-310.0, 0.0}, 0.0, 0.1);
  EXPECT_EQ(tracker.acquire(*expose(cut), prediction(cut)).status, FeatureStatus::cut_by_border);
  const PatternView view = view_of(hall.landmark(), 90.0, {0.0, 0.0}, 0.0, 0.1);
  const LandmarkHall empty(DiscShape{0.05});
  const auto frame = empty.scene().expose(view.wMc, view.intrinsics, {}, sim::ImagingParams{});
  EXPECT_EQ(tracker.acquire(*frame, prediction(view)).status, FeatureStatus::not_found);
}

// Fisher's information of all pixels along an edge about its place and turn, with both levels and
// the blur unknown but well known from 40 px on either side, summed without the closed form.
TEST(CornerBound, IsThatOfAFittedEdgeAtItsEnd) {
  constexpr double kContrast = 150.0;
  constexpr double kNoise = 4.0;
  constexpr int kLength = 48;
  const double blur = std::sqrt(0.7 * 0.7 + 1.0 / 12.0);
  using Normal = Eigen::Matrix<double, 5, 5>;
  Normal information = Normal::Zero();
  for (int row = 0; row < kLength; ++row)
    for (int column = -40; column <= 40; ++column) {
      const double along = row - 0.5 * (kLength - 1);
      const double t = (column + 0.23) / blur;
      const double density = std::exp(-0.5 * t * t) / std::sqrt(2.0 * kPi);
      const double share = 0.5 * std::erfc(-t / std::sqrt(2.0));
      const double slope = kContrast * density / blur;
      Eigen::Matrix<double, 5, 1> row_of;
      row_of << slope, slope * along, 1.0, share, slope * t;
      information += row_of * row_of.transpose() / (kNoise * kNoise);
    }
  const Normal covariance = information.ldlt().solve(Normal::Identity());
  const Eigen::Vector2d lever(1.0, 0.5 * kLength);
  const double at_end = std::sqrt(lever.dot(covariance.topLeftCorner<2, 2>() * lever));
  EXPECT_NEAR(corner_bound(kLength, kContrast, kNoise, blur) / at_end, 1.0, 0.02);
}

TEST(TagAccuracy, CornersLieWithinTwiceTheBoundAndKnowTheirErrors) {
  constexpr int kFrames = 150;
  constexpr double kSidePx = 48.0;
  // Contrast 150, noise 4, blur 0.7 px.
  const LandmarkHall hall(TagShape{17, kSide},
                          "contrast: 0, clutter_per_m2: 0, disc_grey: 60, plate_grey: 210");
  RandomStream random(5, "tag accuracy");
  TagTracker tracker;
  double squares = 0.0;
  double nees = 0.0;
  int count = 0;
  for (int k = 0; k < kFrames; ++k) {
    const PatternView view = view_of(hall.landmark(), kSidePx,
                                     {random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0)},
                                     0.0, random.uniform(0.05, 0.7));
    const auto frame = hall.scene().expose(view.wMc, view.intrinsics, {k}, sim::ImagingParams{});
    const auto found = tracker.find_all(*frame);
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(found[0].status, FeatureStatus::found);
    const auto truth = corners_of(hall.landmark(), view);
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d error = found[0].points[i].uv - truth[i];
      squares += error.squaredNorm();
      nees += error.dot(found[0].points[i].covariance.inverse() * error);
      count += 2;
    }
  }
  const double bound =
      corner_bound(kSidePx, 150.0, std::sqrt(16.0 + 1.0 / 12.0), std::sqrt(0.49 + 1.0 / 12.0));
  const double rms = std::sqrt(squares / count);
  std::printf("corner rms %.4f px, bound %.4f px, NEES per axis %.3f\n", rms, bound, nees / count);
  EXPECT_LE(rms, 2.0 * bound);
  // 1200 squares of unit normals: standard error 0.041; four of them.
  EXPECT_NEAR(nees / count, 1.0, 4.0 * 0.041);
}

TEST(RealTags, AreReadOnTheDetectorsBenchmarkPicture) {
  const std::filesystem::path file =
      "/usr/share/visp-images-data/ViSP-images/AprilTag/benchmark/640x480/tag36_11_640x480.png";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "visp-images-data is not installed";
  std::set<int> read;
  for (const PointsFeature& feature :
       make_point_tracker("tag", {})->find_all(imaging::read_image(file)))
    if (feature.status == FeatureStatus::found) read.insert(std::get<int>(*feature.code));
  EXPECT_EQ(read, (std::set<int>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace vigia::tracking::testing
