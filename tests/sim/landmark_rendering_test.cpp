#include "sim/room.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"
#include "vigia/imaging/tag_bitmap.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {
namespace {

using imaging::Window;

constexpr LandmarkId kPattern = 1;
constexpr LandmarkId kTag = 2;

/// A pattern and a tag side by side on the wall y = 0.
WorldMap gallery() {
  WorldMap world;
  world.plan = FloorPlan({{0, 0}, {12, 0}, {12, 7}, {0, 7}}, 2.8, {}, {});
  Landmark pattern;
  pattern.id = kPattern;
  pattern.wMl = wall_mount({9.0, 0.0, 1.5}, from_deg(90.0));
  PatternShape shape;
  shape.code = {7, 42, 5};
  pattern.shape = shape;
  Landmark tag;
  tag.id = kTag;
  tag.wMl = wall_mount({8.5, 0.0, 1.5}, from_deg(90.0));
  tag.shape = TagShape{123, 0.2};
  world.landmarks = LandmarkMap({pattern, tag});
  return world;
}

ImagingParams still(bool colour, double blur_px = 0.7) {
  ImagingParams params;
  params.noise_sigma = 0.0;
  params.blur_px = blur_px;
  params.colour = colour;
  return params;
}

Eigen::Isometry3d in_front() {
  return camera_at(8.5, 2.5, -80, 6.0);
}

struct MomentSums {
  double area = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();

  void add(double share, const Eigen::Vector2d& at) {
    area += share;
    first += share * at;
  }
  Eigen::Vector2d centre() const { return first / area; }
};

/// Area and first moments of a polygon's image, its sides finely divided (Green's theorem).
MomentSums polygon_moments(const std::vector<Eigen::Vector3d>& corners_w,
                           const Eigen::Isometry3d& wMc, const Intrinsics& k) {
  constexpr int kParts = 50;
  std::vector<Eigen::Vector2d> outline;
  for (std::size_t i = 0; i < corners_w.size(); ++i)
    for (int j = 0; j < kParts; ++j) {
      const double t = static_cast<double>(j) / kParts;
      const Eigen::Vector3d p =
          (1.0 - t) * corners_w[i] + t * corners_w[(i + 1) % corners_w.size()];
      outline.push_back(*project(k, wMc.inverse() * p));
    }
  MomentSums moments;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d a = outline[i];
    const Eigen::Vector2d b = outline[(i + 1) % outline.size()];
    const double cross = a.x() * b.y() - a.y() * b.x();
    moments.area += 0.5 * cross;
    moments.first += cross * (a + b) / 6.0;
  }
  if (moments.area < 0.0) {
    moments.area = -moments.area;
    moments.first = -moments.first;
  }
  return moments;
}

TEST(TagRendering, BlackHasTheAreaAndTheCentreOfItsFields) {
  const WorldMap world = gallery();
  const Landmark& tag = *world.landmarks.find(kTag);
  const Scene scene(world,
                    appearance_of(world,
                                  "disc_grey: 0, plate_grey: 255, wall_grey: 255, contrast: 0, "
                                  "clutter_per_m2: 0"),
                    1);
  for (const double kdu : {0.0, 0.1}) {
    const Intrinsics k = camera(900, kdu);
    const Eigen::Isometry3d wMc = in_front();
    MomentSums truth;
    const imaging::TagBitmap black = imaging::tag_bitmap(123);
    for (int row = 0; row < imaging::kTagFields; ++row)
      for (int column = 0; column < imaging::kTagFields; ++column) {
        if (!black.at(static_cast<std::size_t>(row)).at(static_cast<std::size_t>(column))) continue;
        std::vector<Eigen::Vector3d> corners;
        for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
          corners.push_back(tag.wMl * Eigen::Vector3d(-0.1 + 0.025 * (column + dx),
                                                      0.1 - 0.025 * (row + dy), 0.0));
        const MomentSums field = polygon_moments(corners, wMc, k);
        truth.area += field.area;
        truth.first += field.first;
      }
    const auto image = imaging::grey_image(*scene.expose(wMc, k, {}, still(false)));
    const Eigen::Vector2d middle = truth.centre();
    MomentSums seen;
    for (int v = static_cast<int>(middle.y()) - 60; v <= middle.y() + 60; ++v)
      for (int u = static_cast<int>(middle.x()) - 60; u <= middle.x() + 60; ++u)
        seen.add((255.0 - image[static_cast<unsigned>(v)][u]) / 255.0, Eigen::Vector2d(u, v));
    // Rounding to whole levels leaves 1/12 level² a pixel, on some 2000 pixels of edges.
    EXPECT_NEAR(seen.area, truth.area, 0.3) << "of " << truth.area << ", kdu " << kdu;
    EXPECT_LE((seen.centre() - middle).norm(), 0.005) << "kdu " << kdu;
  }
}

TEST(PatternRendering, EachDotHasItsColourItsCentreAndItsArea) {
  const WorldMap world = gallery();
  const Landmark& pattern = *world.landmarks.find(kPattern);
  const Scene scene(world, appearance_of(world, "contrast: 0, clutter_per_m2: 0"), 1);
  const Intrinsics k = camera(1500);
  const Eigen::Isometry3d wMc = camera_at(8.8, 2.0, -85, 8.0);
  const auto image = imaging::colour_image(*scene.expose(wMc, k, {}, still(true)));
  for (const PatternDot& dot : pattern_dots(std::get<PatternShape>(pattern.shape))) {
    std::vector<Eigen::Vector3d> outline;
    for (int i = 0; i < 40; ++i) {
      const double angle = 2.0 * kPi * i / 40;
      const Eigen::Vector2d p =
          dot.centre_l + dot.radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      outline.push_back(pattern.wMl * Eigen::Vector3d(p.x(), p.y(), 0.0));
    }
    // A polygon of 40 corners has sin(2π/40)/(2π/40) of the circle's area.
    MomentSums truth = polygon_moments(outline, wMc, k);
    truth.area /= std::sin(2.0 * kPi / 40) / (2.0 * kPi / 40);
    const Eigen::Vector2d middle = polygon_moments(outline, wMc, k).centre();
    const auto at = [&](double u, double v) {
      return image[static_cast<unsigned>(std::lround(v))][std::lround(u)];
    };
    const vpRGBa inside = at(middle.x(), middle.y());
    const std::array<int, 3> rgb{inside.R, inside.G, inside.B};
    const auto strongest = std::max_element(rgb.begin(), rgb.end()) - rgb.begin();
    if (dot.colour == DotColour::black)
      EXPECT_LE(*std::max_element(rgb.begin(), rgb.end()), 30) << "dot " << dot.label;
    else
      EXPECT_EQ(strongest, static_cast<int>(dot.colour) - 1) << "dot " << dot.label;
    // In the channel that the dot absorbs: red in blue and green dots, green in the others.
    const int channel = dot.colour == DotColour::green || dot.colour == DotColour::blue ? 0 : 1;
    const auto level = [&](const vpRGBa& p) { return channel == 0 ? p.R : p.G; };
    const double ink = level(inside);
    MomentSums seen;
    const double reach = std::sqrt(truth.area / kPi) * 1.3 + 3.0;
    for (double v = std::round(middle.y() - reach); v <= middle.y() + reach; ++v)
      for (double u = std::round(middle.x() - reach); u <= middle.x() + reach; ++u)
        seen.add((210.0 - level(at(u, v))) / (210.0 - ink), {u, v});
    // The ink's own level is rounded: half of one in 100 and more.
    EXPECT_NEAR(seen.area / truth.area, 1.0, 0.006) << "dot " << dot.label;
    EXPECT_LE((seen.centre() - middle).norm(), 0.02) << "dot " << dot.label;
  }
}

TEST(LandmarkRendering, AWindowEqualsTheCropByteForByte) {
  const WorldMap world = gallery();
  const Scene scene(world, appearance_of(world, "clutter_per_m2: 1, light_kelvin: 3500"), 3);
  ImagingParams params;
  params.colour = true;
  const Intrinsics k = camera(700, 0.05);
  const Eigen::Isometry3d wMc = in_front();
  const auto colour = imaging::colour_image(*scene.expose(wMc, k, {5}, params));
  const auto grey = imaging::grey_image(*scene.expose(wMc, k, {5}, params));
  RandomStream random(1, "windows");
  for (int i = 0; i < 30; ++i) {
    Window window{static_cast<int>(random.index(500)), static_cast<int>(random.index(400)), 0, 0};
    window.width = 1 + static_cast<int>(random.index(static_cast<std::size_t>(640 - window.u)));
    window.height = 1 + static_cast<int>(random.index(static_cast<std::size_t>(480 - window.v)));
    const auto frame = scene.expose(wMc, k, {5}, params);
    std::vector<vpRGBa> pixels(static_cast<std::size_t>(window.width * window.height));
    std::vector<unsigned char> greys(pixels.size());
    frame->read_colour(window, pixels.data(), window.width);
    frame->read_grey(window, greys.data(), window.width);
    for (int row = 0; row < window.height; ++row)
      for (int column = 0; column < window.width; ++column) {
        const auto at = static_cast<std::size_t>(row * window.width + column);
        const auto v = static_cast<unsigned>(window.v + row);
        const auto u = static_cast<unsigned>(window.u + column);
        ASSERT_TRUE(pixels[at] == colour[v][u]) << "window " << i;
        ASSERT_EQ(greys[at], grey[v][u]) << "window " << i;
      }
  }
}

TEST(ColouredLight, GreyFramesAreTheLumaOfColourFrames) {
  const WorldMap world = gallery();
  for (const char* light : {"light_kelvin: 6500", "light_kelvin: 3000", "light_kelvin: 9000"}) {
    const Scene scene(world, appearance_of(world, std::string("light: 0.8, ") + light), 3);
    const Intrinsics k = camera(700);
    const auto colour = imaging::colour_image(*scene.expose(in_front(), k, {}, still(true)));
    const auto grey = imaging::grey_image(*scene.expose(in_front(), k, {}, still(true)));
    double worst = 0.0;
    for (unsigned v = 0; v < 480; ++v)
      for (unsigned u = 0; u < 640; ++u) {
        const vpRGBa& p = colour[v][u];
        worst = std::max(worst, std::abs(0.2126 * p.R + 0.7152 * p.G + 0.0722 * p.B - grey[v][u]));
      }
    // Half a level of rounding on either side.
    EXPECT_LE(worst, 1.01) << light;
  }
}

TEST(ColouredLight, TurnsPaperWarmAndColdAndLeavesTheBrightestChannel) {
  const WorldMap world = gallery();
  const Landmark& tag = *world.landmarks.find(kTag);
  const Intrinsics k = camera(700);
  const auto paper = [&](const std::string& keys) {
    const Scene scene(world, appearance_of(world, keys), 3);
    const auto image = imaging::colour_image(*scene.expose(in_front(), k, {}, still(true)));
    const Eigen::Vector2d uv =
        *project(k, in_front().inverse() * (tag.wMl * Eigen::Vector3d(0.0, -0.125, 0.0)));
    return image[static_cast<unsigned>(uv.y())][static_cast<unsigned>(uv.x())];
  };
  const vpRGBa white = paper("contrast: 1");
  EXPECT_TRUE(white.R == 210 && white.G == 210 && white.B == 210);
  const vpRGBa warm = paper("light_kelvin: 3000");
  EXPECT_EQ(warm.R, 210);
  // Planck's law at 450 nm over that at 600 nm, 3000 K against 6500 K: 0.239.
  EXPECT_NEAR(warm.B, 0.239 * 210.0, 1.0);
  const vpRGBa cold = paper("light_kelvin: 9000");
  EXPECT_EQ(cold.B, 210);
  EXPECT_LT(cold.R, cold.G);
}

}  // namespace
}  // namespace vigia::sim
