#include "vigia/tracking/tag_tracker.hpp"

#include "tag_detector.hpp"
#include "tracking/pattern_views.hpp"
#include "tracking/photograph.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/error.hpp"

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

/// A photograph of one tag, its corners, and what is found in it.
struct TagPhoto {
  std::array<Eigen::Vector2d, 4> corners;
  std::vector<PointsFeature> found;
};

struct TagScene {
  std::string family = "36h11";
  int tag = 17;
  double side_px = 60.0;
  double quiet_zone = 1.0;
  double covered = 0.0;  ///< share of the tag, at a corner
  PhotoParams photo;

  TagScene() {
    // Contrast 150, noise 4, blur 0.7 px.
    photo.fine = 4;
    photo.light = photo.other_light = cv::Vec3f(0.745F, 0.745F, 0.745F);
    photo.white = 1.0;
    photo.noise = 4.0;
  }

  /// The whole grid, with its white rim cut to the quiet zone.
  Print print() const {
    TagDetector detector(family, 1.0, 0);
    const TagGrid& grid = detector.grid(tag);
    std::vector<std::vector<bool>> black;
    for (int row = 0; row < grid.fields; ++row) {
      black.emplace_back();
      for (int column = 0; column < grid.fields; ++column)
        black.back().push_back(!grid.is_white(column, row));
    }
    const double rim = 0.5 * (grid.fields - grid.border);
    const double field = kSide / grid.border;
    return [all = print_of_tag(black, field * grid.fields, 1.0),
            half = 0.5 * kSide + field * (rim + quiet_zone - 1.0)](
               double x, double y) -> std::optional<cv::Vec3f> {
      if (std::max(std::abs(x), std::abs(y)) > half) return std::nullopt;
      return all(x, y);
    };
  }

  TagPhoto shoot(TagTracker& tracker, double slant, RandomStream& random) const {
    const int size = (static_cast<int>(2.2 * side_px) + 40) / 2 * 2;
    const SheetView view = view_of_sheet(
        kSide, side_px, slant, random.uniform(-kPi, kPi), random.uniform(-kPi, kPi), 1200.0,
        {0.5 * size + random.uniform(-1.0, 1.0), 0.5 * size + random.uniform(-1.0, 1.0)}, size,
        size);
    TagPhoto out;
    const double h = 0.5 * kSide;
    const std::array<Eigen::Vector2d, 4> at{Eigen::Vector2d(-h, -h), Eigen::Vector2d(h, -h),
                                            Eigen::Vector2d(h, h), Eigen::Vector2d(-h, h)};
    for (std::size_t k = 0; k < 4; ++k) out.corners[k] = view(at[k]);
    std::vector<Sticker> stickers;
    if (covered > 0.0) {
      const float grey = static_cast<float>(random.uniform(0.05, 0.8));
      stickers.push_back({at[random.index(4)], kSide * std::sqrt(covered), random.index(2) == 0,
                          cv::Vec3f(grey, grey, grey)});
    }
    cv::Mat3f light = plain_wall(size, size, photo.fine, {0.25F, 0.25F, 0.25F});
    lay_sheet(light, photo.fine, view, print(), stickers, random);
    out.found = tracker.find_all(imaging::ImageFrame(grey_photograph(light, photo, random)));
    return out;
  }
};

struct CornerErrors {
  int found = 0;
  double rms = 0.0;
  double nees = 0.0;   ///< per axis
  double worst = 0.0;  ///< of a corner, in stated σ
};

CornerErrors corner_errors(const TagScene& scene, int photos, std::uint64_t seed) {
  RandomStream random(seed, "corners");
  TagTracker tracker;
  CornerErrors errors;
  for (int k = 0; k < photos; ++k) {
    const TagPhoto photo = scene.shoot(tracker, random.uniform(0.0, 0.7), random);
    for (const PointsFeature& feature : photo.found) {
      if (feature.status != FeatureStatus::found) continue;
      ++errors.found;
      for (std::size_t i = 0; i < 4; ++i) {
        const Eigen::Vector2d error = feature.points[i].uv - photo.corners[i];
        const double square = error.dot(feature.points[i].covariance.inverse() * error);
        errors.rms += error.squaredNorm();
        errors.nees += square;
        errors.worst = std::max(errors.worst, std::sqrt(square));
      }
    }
  }
  errors.rms = std::sqrt(errors.rms / (8.0 * errors.found));
  errors.nees /= 8.0 * errors.found;
  return errors;
}

constexpr int kPhotos = 40;
// The eight values of a tag go together: five standard errors of as many squares as tags count.
const double kNeesLimit = 1.2 + 5.0 * std::sqrt(2.0 / (4.0 * kPhotos));

TEST(TagAccuracy, CornersAreWithinAHundredthOfAPixelOrTwoAndKnowTheirErrors) {
  const CornerErrors errors = corner_errors({}, kPhotos, 5);
  std::printf("corner rms %.4f px, NEES per axis %.3f\n", errors.rms, errors.nees);
  EXPECT_EQ(errors.found, kPhotos);
  EXPECT_LE(errors.rms, 0.015);
  EXPECT_LT(errors.nees, kNeesLimit);
  EXPECT_GT(errors.nees, 0.6);
}

struct TagChange {
  const char* name;
  void (*change)(TagScene&);
};

class TagUnder : public ::testing::TestWithParam<TagChange> {};

TEST_P(TagUnder, CornersKnowTheirErrors) {
  TagScene scene;
  GetParam().change(scene);
  const CornerErrors errors = corner_errors(scene, kPhotos, 6);
  EXPECT_GE(errors.found, kPhotos * 9 / 10);
  EXPECT_LT(errors.nees, kNeesLimit);
}

INSTANTIATE_TEST_SUITE_P(
    Conditions, TagUnder,
    ::testing::Values(TagChange{"ASlopeOfLight",
                                [](TagScene& s) {
                                  s.photo.light_slope = {0.2 / 150, 0.0};
                                }},
                      TagChange{"BlurOfTwoPixels", [](TagScene& s) { s.photo.blur_px = 2.0; }},
                      TagChange{"ASideOfTwentyFourPixels", [](TagScene& s) { s.side_px = 24.0; }},
                      TagChange{"AQuietZoneOfHalfAField", [](TagScene& s) { s.quiet_zone = 0.5; }},
                      TagChange{
                          "AResponseAfterTheBlur",
                          [](TagScene& s) { s.photo.response = PhotoParams::Response::srgb; }}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(CoveredTags, AreRefusedOrTheirCornersAreRight) {
  TagScene scene;
  for (const double share : {0.01, 0.05, 0.15}) {
    scene.covered = share;
    const CornerErrors errors = corner_errors(scene, 20, 7);
    EXPECT_LT(errors.found == 0 ? 0.0 : errors.worst, 5.0 * std::sqrt(2.0)) << share;
  }
}

class TagFamilies : public ::testing::TestWithParam<const char*> {};

TEST_P(TagFamilies, AreReadWithCornersInTheReadersOrder) {
  TagScene scene;
  scene.family = GetParam();
  scene.tag = 3;
  scene.quiet_zone = 1.0;
  scene.side_px = 80.0;
  TagTrackerParams params;
  params.family = scene.family;
  TagTracker tracker({}, params);
  RandomStream random(8, "families");
  const TagPhoto photo = scene.shoot(tracker, 0.3, random);
  ASSERT_EQ(photo.found.size(), 1U);
  ASSERT_EQ(photo.found[0].status, FeatureStatus::found);
  EXPECT_EQ(std::get<int>(*photo.found[0].code), 3);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LE((photo.found[0].points[i].uv - photo.corners[i]).norm(), 0.15) << i;
}

INSTANTIATE_TEST_SUITE_P(All, TagFamilies,
                         ::testing::Values("36h11", "25h9", "16h5", "Standard41h12"),
                         [](const auto& test) { return "Tag" + std::string(test.param); });

TEST(TagFamily, AnUnknownOneIsNamedWithTheKnownOnes) {
  TagTrackerParams params;
  params.family = "36h12";
  try {
    TagTracker tracker({}, params);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "there is no tag family '36h12'; known are '36h11', '25h9', '16h5', "
                 "'Standard41h12'");
  }
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
