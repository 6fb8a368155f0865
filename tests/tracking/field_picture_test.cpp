#include "tracking/mirror_photo.hpp"
#include "tracking/photograph.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "vigia/core/random.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/field_picture_run.hpp"
#include "vigia/tracking/panorama.hpp"

namespace vigia::tracking {
namespace {

/// A mirror on a bright ceiling, seen by a camera whose noise and JPEG are those of a cheap one.
/// @p tint: gains of the light's red, green and blue.
imaging::ImageFrame mirror_picture(testing::MirrorScene& scene,
                                   const cv::Vec3f& tint = {1.0F, 1.0F, 1.0F}) {
  scene.at = {0.5, -0.4};
  cv::Mat3f light = scene.render();
  for (int v = 0; v < light.rows; ++v)
    for (int u = 0; u < light.cols; ++u)
      if (std::hypot(u - scene.u0, v - scene.v0) > scene.edge_px)
        light(v, u) = cv::Vec3f(0.6F, 0.6F, 0.62F);
  for (cv::Vec3f& pixel : light) pixel = pixel.mul(tint);
  testing::PhotoParams params;
  params.fine = 1;
  params.white = 0.95;
  params.noise = 3.0;
  params.jpeg = 92;
  params.response = testing::PhotoParams::Response::srgb;
  RandomStream random(3, "noise");
  return imaging::ImageFrame(testing::photograph(light, params, random));
}

/// Goals of a colour that several rays meet. Of a corner post so far off that its bands are two
/// pixels high one ray may see the lowest band alone.
int wide_goals(const FieldPicture& found, FieldColour colour) {
  int count = 0;
  for (const ColourSpan& goal : found.scan.goals)
    count += goal.colour == colour && goal.feet.size() > 2 ? 1 : 0;
  return count;
}

TEST(FieldPicture, ShowsMirrorLinesAndGoalsWithoutAnyMark) {
  testing::MirrorScene scene = testing::field_scene();
  const auto frame = mirror_picture(scene);
  const FieldPicture found = scan_field_picture(frame, {});
  ASSERT_EQ(found.status, FeatureStatus::found);
  EXPECT_NEAR(found.mirror.centre.x(), scene.u0, 1.0);
  EXPECT_NEAR(found.mirror.centre.y(), scene.v0, 1.0);
  EXPECT_NEAR(found.mirror.outer_px, scene.edge_px, 1.5);
  EXPECT_NEAR(found.mirror.inner_px, scene.body_px, 3.0);
  EXPECT_GT(found.scan.points.size(), 60U);
  EXPECT_EQ(wide_goals(found, FieldColour::yellow), 1);
  EXPECT_EQ(wide_goals(found, FieldColour::blue), 1);
}

TEST(FieldPicture, HasItsYellowGoalUnderGreenishLight) {
  testing::MirrorScene scene = testing::field_scene();
  const FieldPicture found = scan_field_picture(mirror_picture(scene, {0.62F, 1.0F, 0.6F}), {});
  ASSERT_EQ(found.status, FeatureStatus::found);
  EXPECT_EQ(wide_goals(found, FieldColour::yellow), 1);
  EXPECT_EQ(wide_goals(found, FieldColour::blue), 1);
}

TEST(FieldPicture, HasNothingOnTheRobotWhoseCameraShowsThroughGreenGlass) {
  testing::MirrorScene scene = testing::field_scene();
  // A camera's dark rim about glass with bright specks, and a thin black circle on the carpet.
  scene.body_px = 0.0;
  auto frame = mirror_picture(scene);
  vpImage<vpRGBa> image = imaging::colour_image(frame);
  cv::Mat canvas(frame.height(), frame.width(), CV_8UC4, image.bitmap);
  const cv::Point middle(static_cast<int>(scene.u0), static_cast<int>(scene.v0));
  cv::circle(canvas, middle, 40, {25, 50, 25, 255}, cv::FILLED, cv::LINE_AA);
  cv::circle(canvas, middle, 28, {70, 170, 60, 255}, cv::FILLED, cv::LINE_AA);
  cv::circle(canvas, middle, 95, {20, 20, 20, 255}, 1, cv::LINE_AA);
  for (int k = 0; k < 12; ++k)
    cv::circle(canvas, middle + cv::Point(6 + k % 4 * 4, 4 * (k / 4) - 6), 2, {220, 225, 220, 255},
               cv::FILLED, cv::LINE_AA);
  const FieldPicture found = scan_field_picture(imaging::ImageFrame(image), {});
  ASSERT_EQ(found.status, FeatureStatus::found);
  EXPECT_NEAR(found.mirror.inner_px, 40.0, 6.0);
  for (const LinePoint& point : found.scan.points) EXPECT_GT(point.centre_px(), 40.0);
}

TEST(FieldPicture, IsNoneWhereThereIsNoMirror) {
  const auto count = [](const vpImage<vpRGBa>& image) {
    return features_in(scan_field_picture(imaging::ImageFrame(image), {}));
  };
  EXPECT_EQ(count(vpImage<vpRGBa>(480, 640, vpRGBa(235, 235, 235))), 0);
  EXPECT_EQ(count(vpImage<vpRGBa>(480, 640, vpRGBa(60, 150, 70))), 0);
  // A page of text, and a circle without a field.
  vpImage<vpRGBa> page(480, 640, vpRGBa(250, 250, 250));
  cv::Mat canvas(480, 640, CV_8UC4, page.bitmap);
  for (int line = 30; line < 470; line += 18)
    cv::putText(canvas, "the quick brown fox jumps over the lazy dog", {10, line},
                cv::FONT_HERSHEY_SIMPLEX, 0.6, {20, 20, 20, 255}, 1, cv::LINE_AA);
  EXPECT_EQ(count(page), 0);
  cv::circle(canvas, {320, 240}, 200, {90, 60, 40, 255}, cv::FILLED, cv::LINE_AA);
  EXPECT_EQ(count(page), 0);
}

TEST(FieldPicture, HasOneLineOfTheTableForTheMirrorAndEachFeature) {
  testing::MirrorScene scene = testing::field_scene();
  const FieldPicture found = scan_field_picture(mirror_picture(scene), {});
  const std::string lines = field_csv_lines(found, "start,");
  std::size_t feet = 0;
  for (const auto* spans : {&found.scan.goals, &found.scan.posts})
    for (const ColourSpan& span : *spans) feet += span.feet.size();
  EXPECT_EQ(static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n')),
            1 + found.scan.points.size() + feet);
  // Every line has a field for each column.
  const std::string header = field_csv_header();
  const auto columns = std::count(header.begin(), header.end(), ',') + 1;
  const auto rows = std::count(lines.begin(), lines.end(), '\n');
  EXPECT_EQ(std::count(lines.begin(), lines.end(), ','), rows * columns);
}

TEST(Panorama, HasTheImagesUAxisInItsMiddle) {
  vpImage<vpRGBa> image(200, 200, vpRGBa(0, 0, 0));
  cv::Mat canvas(200, 200, CV_8UC4, image.bitmap);
  cv::circle(canvas, {160, 100}, 6, {255, 0, 0, 255}, cv::FILLED);
  const vpImage<vpRGBa> unwrapped =
      unwrapped_panorama(imaging::ImageFrame(image), {{100.0, 100.0}, 20.0, 80.0});
  ASSERT_EQ(unwrapped.getHeight(), 60U);
  EXPECT_GT(unwrapped[20][unwrapped.getWidth() / 2].R, 200);
  EXPECT_EQ(unwrapped[20][unwrapped.getWidth() / 4].R, 0);
}

}  // namespace
}  // namespace vigia::tracking
