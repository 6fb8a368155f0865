#include "vigia/report/printable.hpp"

#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/camera.hpp"
#include "vigia/core/error.hpp"
#include "vigia/core/random.hpp"
#include "vigia/imaging/canvas.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"
#include "vigia/tracking/patch_finder.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::report {
namespace {

constexpr double kMetresPerInch = 0.0254;
constexpr double kDpi = 150.0;
constexpr int kFine = 5;  // rays a pixel, across and down

/// A rasterised page hung in the plane z = 0 of a landmark's frame.
struct HungPage {
  vpImage<vpRGBa> print;
  PrintedPage page;
  double dpi = kDpi;

  /// What is printed at a point of the landmark's frame; outside the page, a grey wall.
  Eigen::Array3d at(const Eigen::Vector2d& p_l) const {
    const double scale = dpi / kMetresPerInch;
    const double x = (page.centre_m.x() + p_l.x()) * scale - 0.5;
    const double y = (page.centre_m.y() - p_l.y()) * scale - 0.5;
    const auto u = static_cast<int>(std::lround(x));
    const auto v = static_cast<int>(std::lround(y));
    if (u < 0 || v < 0 || u >= static_cast<int>(print.getWidth()) ||
        v >= static_cast<int>(print.getHeight()))
      return Eigen::Array3d::Constant(140.0);
    const vpRGBa& p = print[static_cast<unsigned>(v)][u];
    return {static_cast<double>(p.R), static_cast<double>(p.G), static_cast<double>(p.B)};
  }
};

/// The page through a camera: the mean over rays spread evenly over each pixel, dimmed to 0.85 so
/// that paper does not saturate, with noise.
imaging::ImageFrame photograph(const HungPage& hung, const Eigen::Isometry3d& lMc,
                               const Intrinsics& k) {
  vpImage<vpRGBa> image(480, 640);
  RandomStream random(3, "photograph");
  const auto byte = [&](double value) {
    return static_cast<unsigned char>(
        std::lround(std::clamp(0.85 * value + 2.0 * random.normal(), 0.0, 255.0)));
  };
  for (unsigned v = 0; v < 480; ++v)
    for (unsigned u = 0; u < 640; ++u) {
      Eigen::Array3d sum = Eigen::Array3d::Zero();
      for (int i = 0; i < kFine * kFine; ++i) {
        const Eigen::Vector2d uv(u + (i % kFine + 0.5) / kFine - 0.5,
                                 v + (i / kFine + 0.5) / kFine - 0.5);
        const Eigen::Vector2d xy = unproject(k, uv);
        const Eigen::Vector3d ray = lMc.linear() * Eigen::Vector3d(xy.x(), xy.y(), 1.0);
        const Eigen::Vector3d p = lMc.translation() - lMc.translation().z() / ray.z() * ray;
        sum += hung.at(p.head<2>());
      }
      sum /= kFine * kFine;
      image[v][u] = vpRGBa(byte(sum[0]), byte(sum[1]), byte(sum[2]));
    }
  return imaging::ImageFrame(std::move(image));
}

/// A camera at a distance, 35° to the side, looking at the landmark's centre.
Eigen::Isometry3d oblique(double distance) {
  const double angle = 0.6;
  Eigen::Isometry3d lMc = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d eye = distance * Eigen::Vector3d(std::sin(angle), 0.1, std::cos(angle));
  const Eigen::Vector3d z = -eye.normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitY()).normalized();
  lMc.linear() << x, z.cross(x), z;
  lMc.translation() = eye;
  return lMc;
}

/// The camera in which @p reach metres fill 200 px at @p distance.
Intrinsics zoom(double reach, double distance) {
  Intrinsics k;
  k.px = k.py = 200.0 * distance / reach;
  return k;
}

struct Printing : ::testing::TestWithParam<const char*> {
  vigia::testing::TempDir dir;

  /// Prints to the format of the parameter and brings it to pixels with a program of its own.
  HungPage print(const LandmarkShape& shape) {
    const std::string format = GetParam();
    const auto file = dir.path() / ("landmark." + format);
    print_landmark(shape, file, kDpi);
    auto png = dir.path() / "landmark.png";
    const std::string dpi = std::to_string(static_cast<int>(kDpi));
    std::string command = "true";
    if (format == "pdf")
      command = "pdftoppm -singlefile -png -r " + dpi + " " + file.string() + " " +
                (dir.path() / "landmark").string();
    if (format == "svg")
      command =
          "rsvg-convert -d " + dpi + " -p " + dpi + " -o " + png.string() + " " + file.string();
    const auto result = vigia::testing::run_process(command, dir.path());
    EXPECT_EQ(result.status, 0) << result.err;
    return {imaging::colour_image(imaging::read_image(png)), printed_page(shape)};
  }
};

TEST_P(Printing, APageHasItsTrueSize) {
  PatternShape shape;
  shape.code = {3, 17, 8};
  const HungPage hung = print(shape);
  const double scale = kDpi / kMetresPerInch;
  // Rasterisers round a page up to whole pixels.
  EXPECT_NEAR(hung.print.getWidth(), hung.page.width_m * scale, 1.01);
  EXPECT_NEAR(hung.print.getHeight(), hung.page.height_m * scale, 1.01);
}

TEST_P(Printing, APatternSeenByACameraSaysWhatWasAsked) {
  for (const PatternCode& code : {PatternCode{3, 17, 8}, PatternCode{0, 80, 0}}) {
    PatternShape shape;
    shape.code = code;
    const imaging::ImageFrame frame = photograph(print(shape), oblique(2.0), zoom(0.13, 2.0));
    const auto found = tracking::make_point_tracker("pattern", {})->find_all(frame);
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(found[0].status, tracking::FeatureStatus::found);
    EXPECT_EQ(std::get<PatternCode>(*found[0].code), code);
    // At true scale each point lies where the camera has it; a dot's ellipse, seen obliquely, is
    // centred a little beside the dot's centre, and the print's pixels are 0.17 mm wide.
    const Eigen::Isometry3d cMl = oblique(2.0).inverse();
    const auto dots = pattern_dots(shape);
    EXPECT_EQ(found[0].points.size(), dots.size());
    for (const LabelledPoint& point : found[0].points) {
      const auto& dot = dots[static_cast<std::size_t>(point.label)];
      const Eigen::Vector2d uv =
          *project(zoom(0.13, 2.0), cMl * Eigen::Vector3d(dot.centre_l.x(), dot.centre_l.y(), 0.0));
      EXPECT_LE((point.uv - uv).norm(), 0.5) << "dot " << dot.label;
    }
  }
}

TEST_P(Printing, ATagSeenByACameraIsTheOneAsked) {
  const TagShape shape{233, 0.12};
  const imaging::ImageFrame frame = photograph(print(shape), oblique(1.5), zoom(0.11, 1.5));
  const auto found = tracking::make_point_tracker("tag", {})->find_all(frame);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(std::get<int>(*found[0].code), 233);
  const Eigen::Isometry3d cMl = oblique(1.5).inverse();
  const double h = 0.06;
  const Eigen::Vector3d corners[] = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  for (const LabelledPoint& point : found[0].points)
    EXPECT_LE((point.uv - *project(zoom(0.11, 1.5), cMl * corners[point.label])).norm(), 0.5)
        << "corner " << point.label;
}

TEST_P(Printing, ADiscSeenByACameraHasItsRadius) {
  const DiscShape shape{0.06};
  Eigen::Isometry3d lMc = Eigen::Isometry3d::Identity();
  lMc.linear().diagonal() << 1.0, -1.0, -1.0;
  lMc.translation() << 0.0, 0.0, 1.5;
  const Intrinsics k = zoom(0.11, 1.5);
  const imaging::ImageFrame frame = photograph(print(shape), lMc, k);
  imaging::Canvas canvas;
  canvas.attach(frame);
  const auto found = tracking::make_ellipse_tracker("disc")->find_all(canvas);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].ellipse.a, 0.06 / 1.5 * k.px, 0.3);
  EXPECT_NEAR(found[0].ellipse.u, 319.5, 0.5);
  EXPECT_NEAR(found[0].ellipse.v, 239.5, 0.5);
}

TEST_P(Printing, ACeilingPatchSeenByACameraIsOneAndItsTonguePointsUp) {
  const PatchShape shape{0.09, 0.03, true};
  Eigen::Isometry3d lMc = Eigen::Isometry3d::Identity();
  lMc.linear().diagonal() << 1.0, -1.0, -1.0;
  lMc.translation() << 0.0, 0.0, 1.5;
  const Intrinsics k = zoom(0.3, 1.5);
  tracking::PatchFinderParams params;
  params.length_px = 0.09 / 1.5 * k.px;
  params.width_px = 0.03 / 1.5 * k.px;
  const auto scan = tracking::PatchFinder(params).find(photograph(print(shape), lMc, k));
  ASSERT_EQ(scan.patches.size(), 1U);
  EXPECT_LT((scan.patches[0].uv - Eigen::Vector2d(319.5, 239.5)).norm(), 0.5);
  EXPECT_NEAR(to_deg(scan.patches[0].angle), -90.0, 1.0);
  EXPECT_GT(scan.patches[0].forward_log_odds, 5.0);
}

INSTANTIATE_TEST_SUITE_P(Formats, Printing, ::testing::Values("png", "pdf", "svg"),
                         [](const auto& format) { return std::string(format.param); });

TEST(Printable, APngSaysHowLargeItsPixelsAre) {
  const vigia::testing::TempDir dir;
  print_landmark(TagShape{1, 0.05}, dir.path() / "tag.png", 254.0);
  const std::string bytes = vigia::testing::read_text(dir.path() / "tag.png");
  // 254 dots an inch are 10,000 (0x2710) a metre, across and down; 1: metres.
  EXPECT_EQ(bytes.substr(37, 4), "pHYs");
  EXPECT_EQ(bytes.substr(41, 9), std::string("\0\0\x27\x10\0\0\x27\x10\x01", 9));
}

TEST(Printable, TheSameLandmarkGivesTheSameBytes) {
  const vigia::testing::TempDir dir;
  for (const char* ending : {"png", "svg", "pdf"}) {
    const auto one = dir.path() / (std::string("one.") + ending);
    const auto two = dir.path() / (std::string("two.") + ending);
    print_landmark(DiscShape{0.1}, one);
    print_landmark(DiscShape{0.1}, two);
    EXPECT_EQ(vigia::testing::read_text(one), vigia::testing::read_text(two)) << ending;
  }
}

TEST(Printable, WhatCannotBePrintedIsSaid) {
  const vigia::testing::TempDir dir;
  EXPECT_THROW(print_landmark(DiscShape{0.1}, dir.path() / "disc.gif"), InputError);
  EXPECT_THROW(print_landmark(DiscShape{1.0}, dir.path() / "disc.png", 1200.0), InputError);
}

TEST(Paper, ALandmarkIsAsLargeAsTheSheetTakesIt) {
  const struct {
    Paper paper;
    double width_m, height_m;
  } sheets[] = {
      {Paper::a4, 0.210, 0.297}, {Paper::a3, 0.297, 0.420}, {Paper::letter, 0.2159, 0.2794}};
  for (const auto& sheet : sheets)
    for (const LandmarkShape& shape :
         {LandmarkShape(DiscShape{}), LandmarkShape(TagShape{}), LandmarkShape(PatternShape{})}) {
      const PrintedPage page = printed_page(fitted_to(shape, sheet.paper), sheet.paper);
      EXPECT_DOUBLE_EQ(page.width_m, sheet.width_m);
      EXPECT_DOUBLE_EQ(page.height_m, sheet.height_m);
      EXPECT_NEAR(page.half_width_m, 0.5 * sheet.width_m, 1e-12);
      EXPECT_DOUBLE_EQ(page.centre_m.x(), 0.5 * sheet.width_m);
    }
}

TEST(Paper, ALandmarkThatIsTooLargeForItIsAnInputError) {
  EXPECT_THROW(print_landmark(DiscShape{0.5}, "never.pdf", 300.0, Paper::a4), InputError);
}

}  // namespace
}  // namespace vigia::report
