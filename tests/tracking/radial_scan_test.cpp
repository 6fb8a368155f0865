#include "vigia/tracking/radial_scan.hpp"

#include "tracking/mirror_photo.hpp"
#include "tracking/photograph.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::tracking {
namespace {

using testing::MirrorScene;

/// The robot's frame lies under the mirror with x along the image's u.
FloorView view_of(const MirrorScene& scene) {
  FloorView view;
  view.mirror.width = scene.width;
  view.mirror.height = scene.height;
  view.mirror.px = view.mirror.py = scene.focal_px;
  view.mirror.u0 = scene.u0;
  view.mirror.v0 = scene.v0;
  view.mirror.max_angle = 2.0 * std::atan(scene.edge_px / scene.focal_px);
  view.rMc.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  view.rMc.translation() = Eigen::Vector3d(0.0, 0.0, scene.height_m);
  view.inner_px = scene.body_px + 2.0;
  return view;
}

testing::PhotoParams photo(double noise) {
  testing::PhotoParams params;
  params.fine = 1;
  params.blur_px = 0.7;
  params.white = 0.95;
  params.noise = noise;
  return params;
}

imaging::ImageFrame frame_of(const cv::Mat3f& light, const testing::PhotoParams& params,
                             std::uint64_t seed) {
  RandomStream random(seed, "noise");
  return imaging::ImageFrame(testing::photograph(light, params, random));
}

/// Errors of line points against where the scene's lines lie on the rays.
struct Errors {
  std::vector<double> squares;  ///< in stated variances, of lines that stand alone
  int false_points = 0;
  double worst_px = 0.0;
};

void compare(const RadialScan& scan, const MirrorScene& scene, Errors& errors) {
  constexpr double kAlone = 8.0;  // px, to the next line on the ray
  for (const LinePoint& point : scan.points) {
    double error = 1e9;
    int near = 0;
    for (const auto& crossing : scene.crossings(scan.angle(point.ray))) {
      const double off = point.centre_px() - 0.5 * (crossing.inner_px + crossing.outer_px);
      near += std::abs(off) < kAlone ? 1 : 0;
      if (std::abs(off) < std::abs(error)) error = off;
    }
    if (std::abs(error) > 2.5) {
      ++errors.false_points;
      continue;
    }
    errors.worst_px = std::max(errors.worst_px, std::abs(error));
    if (near == 1) errors.squares.push_back(std::pow(error / point.sigma_px, 2));
  }
}

TEST(NoisyCentresOfFieldLines, AreAsGoodAsTheirVariancesSay) {
  RandomStream random(20, "poses");
  Errors errors;
  for (int pose = 0; pose < 8; ++pose) {
    MirrorScene scene = testing::field_scene();
    scene.at = {random.uniform(-5.0, 5.0), random.uniform(-3.2, 3.2)};
    scene.heading = random.uniform(0.0, 2.0 * kPi);
    const auto frame = frame_of(scene.render(), photo(4.0), static_cast<std::uint64_t>(pose));
    RadialScanner scanner(view_of(scene), FieldPalette{});
    compare(scanner.scan(frame), scene, errors);
  }
  EXPECT_EQ(errors.false_points, 0);
  const auto n = static_cast<double>(errors.squares.size());
  ASSERT_GT(n, 600.0);
  const double nees = std::accumulate(errors.squares.begin(), errors.squares.end(), 0.0) / n;
  EXPECT_GT(nees, 0.8);
  EXPECT_LT(nees, 1.2);
  const auto beyond = std::count_if(errors.squares.begin(), errors.squares.end(),
                                    [](double square) { return square > 9.0; });
  EXPECT_LT(static_cast<double>(beyond), 0.01 * n);
  EXPECT_LT(errors.worst_px, 1.0);
}

TEST(RadialScan, FindsBothGoalsAndTheCornerPostsInSight) {
  MirrorScene scene = testing::field_scene();
  scene.at = {0.8, -0.6};
  RadialScanParams params;
  params.ray_step = from_deg(1.0);
  RadialScanner scanner(view_of(scene), FieldPalette{}, params);
  const RadialScan scan = scanner.scan(frame_of(scene.render(), photo(4.0), 1));
  ASSERT_EQ(scan.goals.size(), 2U);
  ASSERT_EQ(scan.posts.size(), 4U);
  for (const ColourSpan& goal : scan.goals) {
    const double x = goal.colour == FieldColour::yellow ? -6.07 : 6.07;
    const Eigen::Vector2d low = Eigen::Vector2d(x, -1.0) - scene.at;
    const Eigen::Vector2d high = Eigen::Vector2d(x, 1.0) - scene.at;
    const double middle = wrap_angle(0.5 * (goal.first_angle + goal.last_angle));
    const double truth =
        x > 0 ? 0.5 * (std::atan2(low.y(), low.x()) + std::atan2(high.y(), high.x()))
              : kPi + 0.5 * (std::atan(low.y() / low.x()) + std::atan(high.y() / high.x()));
    EXPECT_NEAR(wrap_angle(middle - truth), 0.0, from_deg(1.0));
    const ColourFoot& foot = goal.feet[goal.feet.size() / 2];
    const auto p = floor_point(view_of(scene), scan.pixel(foot.ray, foot.foot_px));
    ASSERT_TRUE(p.has_value());
    // v goes down where the robot's y goes left.
    EXPECT_NEAR(p->x(), x - scene.at.x(), 0.25);
  }
}

TEST(RadialScan, TellsAPostByTheColourOfItsLowestBand) {
  MirrorScene scene = testing::field_scene();
  RadialScanParams params;
  params.ray_step = from_deg(1.0);
  RadialScanner scanner(view_of(scene), FieldPalette{}, params);
  const RadialScan scan = scanner.scan(frame_of(scene.render(), photo(4.0), 1));
  ASSERT_EQ(scan.posts.size(), 4U);
  for (const ColourSpan& post : scan.posts) {
    const double angle = 0.5 * (post.first_angle + post.last_angle);
    EXPECT_EQ(post.colour, std::cos(angle) < 0.0 ? FieldColour::yellow : FieldColour::blue);
  }
}

TEST(RadialScan, TakesNoRobotNoBannerAndNoClothesForALine) {
  MirrorScene scene = testing::field_scene();
  const auto clean = frame_of(scene.render(), photo(4.0), 1);
  // Grey and white robots on the carpet, a white banner and people beyond it.
  const auto box = [&](double x, double y, double size, double height, const cv::Vec3f& paint) {
    scene.boxes.push_back(
        {{x - size, y - size}, {x + size, y + size}, height, paint, std::nullopt});
  };
  box(2.4, 1.9, 0.25, 0.6, testing::kWhitePaint);
  box(-2.6, -1.2, 0.25, 0.5, {0.3F, 0.3F, 0.3F});
  box(3.0, -2.0, 0.25, 0.6, {0.9F, 0.2F, 0.2F});
  box(-1.9, 2.3, 0.15, 0.7, {0.75F, 0.73F, 0.7F});
  scene.boxes.push_back({{-7.4, 5.1}, {7.4, 5.3}, 0.5, testing::kWhitePaint, std::nullopt});
  scene.boxes.push_back(
      {{-3.0, -5.6}, {-2.6, -5.4}, 1.7, testing::kWhitePaint, testing::kBluePaint});
  const auto frame = frame_of(scene.render(), photo(4.0), 1);
  RadialScanner scanner(view_of(scene), FieldPalette{});
  const std::size_t before = scanner.scan(clean).points.size();
  const RadialScan scan = scanner.scan(frame);
  Errors errors;
  compare(scan, scene, errors);
  EXPECT_EQ(errors.false_points, 0);
  EXPECT_GT(scan.points.size(), before * 3 / 5);
}

TEST(RadialScan, ReadsOnlyThePixelsOfItsRays) {
  class Counted : public imaging::ImageFrame {
   public:
    using ImageFrame::ImageFrame;
    void read_colour_runs(const std::vector<imaging::Run>& runs, vpRGBa* out) const override {
      pixels += imaging::pixels_in(runs);
      ImageFrame::read_colour_runs(runs, out);
    }
    mutable std::size_t pixels = 0;
  };
  const MirrorScene scene = testing::field_scene();
  RandomStream random(1, "noise");
  const Counted frame(testing::photograph(scene.render(), photo(4.0), random));
  RadialScanner scanner(view_of(scene), FieldPalette{});
  scanner.scan(frame);
  // Two pixels a step on 120 rays of 194 px.
  EXPECT_LT(frame.pixels, 2U * 120U * 194U);
  EXPECT_GT(frame.pixels, 120U * 194U);
}

TEST(RadialScan, SaysThatTheLightHasLeftThePalette) {
  const MirrorScene scene = testing::field_scene();
  const cv::Mat3f light = scene.render();
  RadialScanner scanner(view_of(scene), FieldPalette{});
  EXPECT_EQ(scanner.scan(frame_of(light, photo(4.0), 1)).light, LightStatus::in_range);
  testing::PhotoParams dark = photo(4.0);
  dark.white = 0.05;
  EXPECT_EQ(scanner.scan(frame_of(light, dark, 1)).light, LightStatus::too_dark);
  testing::PhotoParams purple = photo(4.0);
  purple.white = 2.0;
  purple.light = purple.other_light = {1.0F, 0.35F, 2.2F};
  EXPECT_EQ(scanner.scan(frame_of(light, purple, 1)).light, LightStatus::no_green);
}

TEST(RadialScan, FindsNoFieldInABlankPicture) {
  const vpImage<vpRGBa> blank(480, 640, vpRGBa(240, 240, 240));
  RadialScanner scanner(MirrorImage{{319.5, 239.5}, 30.0, 230.0}, FieldPalette{});
  const RadialScan scan = scanner.scan(imaging::ImageFrame(blank));
  EXPECT_TRUE(scan.points.empty());
  EXPECT_TRUE(scan.goals.empty());
  EXPECT_EQ(scan.light, LightStatus::no_green);
}

}  // namespace
}  // namespace vigia::tracking
