#include "vigia/sim/scene.hpp"

#include "sim/room.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

using imaging::Window;

struct View {
  Eigen::Isometry3d wMc;
  Intrinsics intrinsics;
};

/// Views with distortion, walls in front of discs, the box, large and small discs.
std::vector<View> views() {
  return {{camera_at(1.5, 2.0, 10, -8), camera(582, 0.06)},
          {camera_at(4.5, 2.5, 60), camera(582, 0.06)},
          {camera_at(8.5, 3.0, 0, 8), camera(2126, 0.008)},
          {camera_at(5.0, 5.0, 110, 5), camera(1024, 0.03)},
          {camera_at(9.0, 2.0, -90, 5), camera(3490, 0.002)},
          {camera_at(4.3, 2.6, 0, -40), camera(300, -0.02)}};
}

TEST(Scene, AWindowEqualsTheCropOfTheFullFrameByteForByte) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, "clutter_per_m2: 1"), 3);
  RandomStream random(1, "windows");
  for (const View& view : views()) {
    const Stamp stamp{static_cast<std::int64_t>(random.index(1000000))};
    const auto full = imaging::grey_image(*scene.expose(view.wMc, view.intrinsics, stamp, {}));
    const auto again = scene.expose(view.wMc, view.intrinsics, stamp, {});
    for (int i = 0; i < 40; ++i) {
      Window window;
      window.u = static_cast<int>(random.index(639));
      window.v = static_cast<int>(random.index(479));
      window.width = 1 + static_cast<int>(random.index(static_cast<std::size_t>(640 - window.u)));
      window.height = 1 + static_cast<int>(random.index(static_cast<std::size_t>(480 - window.v)));
      // Every other window is the first thing that its frame is asked for.
      const auto fresh = scene.expose(view.wMc, view.intrinsics, stamp, {});
      const imaging::Frame& frame = i % 2 == 0 ? *fresh : *again;
      std::vector<unsigned char> pixels(static_cast<std::size_t>(window.width * window.height));
      frame.read_grey(window, pixels.data(), window.width);
      for (int row = 0; row < window.height; ++row)
        ASSERT_TRUE(std::equal(pixels.begin() + row * window.width,
                               pixels.begin() + (row + 1) * window.width,
                               full[static_cast<unsigned>(window.v + row)] + window.u))
            << "row " << row << " of window at " << window.u << ", " << window.v;
    }
  }
}

TEST(Scene, AColourWindowEqualsTheCropOfTheFullFrame) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, "clutter_per_m2: 1"), 3);
  ImagingParams params;
  params.colour = true;
  for (const View& view : views()) {
    const auto frame = scene.expose(view.wMc, view.intrinsics, {7}, params);
    const auto full = imaging::colour_image(*frame);
    const Window window{211, 103, 157, 99};
    std::vector<vpRGBa> pixels(static_cast<std::size_t>(window.width * window.height));
    scene.expose(view.wMc, view.intrinsics, {7}, params)
        ->read_colour(window, pixels.data(), window.width);
    for (int row = 0; row < window.height; ++row)
      for (int column = 0; column < window.width; ++column)
        ASSERT_TRUE(
            pixels[static_cast<std::size_t>(row * window.width + column)] ==
            full[static_cast<unsigned>(window.v + row)][static_cast<unsigned>(window.u + column)]);
  }
}

std::vector<imaging::Run> random_runs(RandomStream& random, int most) {
  std::vector<imaging::Run> runs;
  for (int i = 0; i < 400; ++i) {
    imaging::Run run;
    run.v = static_cast<int>(random.index(480));
    run.u_begin = static_cast<int>(random.index(640));
    run.u_end = std::min(
        640, run.u_begin + 1 + static_cast<int>(random.index(static_cast<std::size_t>(most))));
    runs.push_back(run);
  }
  return runs;
}

TEST(Scene, RunsEqualTheCropOfTheFullFrameByteForByte) {
  const WorldMap world = test_room();
  MapReader reader(parse_config("version: 1\nstripes: [{from_m: [1, 1], to_m: [11, 6]}]\n", "test"),
                   "world");
  const Scene scene(world, read_appearance(reader, world), 3);
  ImagingParams params;
  params.colour = true;
  UnifiedOmni mirror;
  Eigen::Isometry3d wMm(Eigen::Translation3d(4.0, 3.0, 1.0));
  wMm.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  RandomStream random(2, "runs");
  std::vector<std::pair<Eigen::Isometry3d, CameraModel>> shots{{wMm, mirror}};
  for (const View& view : views()) shots.emplace_back(view.wMc, view.intrinsics);
  for (const auto& [wMc, model] : shots) {
    for (const bool blurred : {false, true}) {
      const Exposure exposure{blurred ? std::vector<Exposure::Instant>{{wMc, {}}, {wMc, {}}}
                                      : std::vector<Exposure::Instant>{{wMc, {}}},
                              std::nullopt};
      const auto runs = random_runs(random, 40);
      const auto full = scene.expose(exposure, model, {9}, params);
      const auto grey = imaging::grey_image(*full);
      const auto colour = imaging::colour_image(*full);
      std::vector<unsigned char> grey_runs(imaging::pixels_in(runs));
      std::vector<vpRGBa> colour_runs(grey_runs.size());
      scene.expose(exposure, model, {9}, params)->read_grey_runs(runs, grey_runs.data());
      scene.expose(exposure, model, {9}, params)->read_colour_runs(runs, colour_runs.data());
      std::size_t at = 0;
      for (const imaging::Run& run : runs) {
        for (int u = run.u_begin; u < run.u_end; ++u, ++at) {
          const auto v = static_cast<unsigned>(run.v);
          ASSERT_EQ(grey_runs[at], grey[v][static_cast<unsigned>(u)]);
          ASSERT_TRUE(colour_runs[at] == colour[v][static_cast<unsigned>(u)]);
        }
      }
    }
  }
}

TEST(Scene, CamerasThatExposeAtOnceHaveNoiseOfTheirOwn) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, "contrast: 0"), 3);
  const View view = views()[1];
  const auto of_camera = [&](CameraId camera) {
    return imaging::grey_image(*scene.expose(view.wMc, view.intrinsics, {40}, {}, camera));
  };
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  const auto truth = imaging::grey_image(*scene.expose(view.wMc, view.intrinsics, {40}, clean));
  auto left = of_camera(0);
  const auto right = of_camera(1);
  EXPECT_TRUE(left == imaging::grey_image(*scene.expose(view.wMc, view.intrinsics, {40}, {})));
  double product = 0.0;
  const auto n = static_cast<double>(truth.getSize());
  for (unsigned i = 0; i < truth.getSize(); ++i)
    product += (left.bitmap[i] - truth.bitmap[i]) * (right.bitmap[i] - truth.bitmap[i]);
  // σ² = 16 a pixel; the rounding of the common truth adds up to 1/12.
  EXPECT_LT(std::abs(product / n), 4.5 * 16.2 / std::sqrt(n) + 1.0 / 12.0);
}

TEST(Scene, TheSameSeedAndStampGiveTheSameBytesAndOthersDoNot) {
  const WorldMap world = test_room();
  const auto look = appearance_of(world, "");
  const Scene scene(world, look, 3);
  const Scene twin(world, look, 3);
  const Scene other(world, look, 4);
  const View view = views().front();
  const auto picture = [&](const Scene& s, std::int64_t ns) {
    return imaging::grey_image(*s.expose(view.wMc, view.intrinsics, {ns}, {}));
  };
  auto image = picture(scene, 40);
  EXPECT_TRUE(image == picture(twin, 40));
  EXPECT_FALSE(image == picture(other, 40));
  EXPECT_FALSE(image == picture(scene, 41));
}

TEST(Scene, PixelNoiseHasItsVarianceAndIsIndependentOfNeighboursAndFrames) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, ""), 3);
  const View view = views()[1];
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  ImagingParams noisy;
  noisy.noise_sigma = 4.0;
  const auto truth = imaging::grey_image(*scene.expose(view.wMc, view.intrinsics, {0}, clean));
  const auto a = imaging::grey_image(*scene.expose(view.wMc, view.intrinsics, {0}, noisy));
  const auto b = imaging::grey_image(*scene.expose(view.wMc, view.intrinsics, {40000000}, noisy));
  double mean = 0.0;
  double square = 0.0;
  double right = 0.0;
  double below = 0.0;
  double frames = 0.0;
  int n = 0;
  const auto error = [&](const vpImage<unsigned char>& image, unsigned v, unsigned u) {
    return static_cast<double>(image[v][u]) - truth[v][u];
  };
  for (unsigned v = 0; v + 1 < 480; ++v) {
    for (unsigned u = 0; u + 1 < 640; ++u) {
      const double e = error(a, v, u);
      mean += e;
      square += e * e;
      right += e * error(a, v, u + 1);
      below += e * error(a, v + 1, u);
      frames += e * error(b, v, u);
      ++n;
    }
  }
  // The rounding of both pictures adds to the variance: up to 1/12 each.
  constexpr double kSigmas = 4.5;
  const double se = 16.2 / std::sqrt(1.0 * n);
  EXPECT_LT(std::abs(mean / n), kSigmas * 4.03 / std::sqrt(1.0 * n));
  EXPECT_GT(square / n, 16.0 - kSigmas * std::sqrt(2.0) * se);
  EXPECT_LT(square / n, 16.0 + 2.0 / 12.0 + kSigmas * std::sqrt(2.0) * se);
  EXPECT_LT(std::abs(right / n), kSigmas * se + 1.0 / 12.0 * 0.5);
  EXPECT_LT(std::abs(below / n), kSigmas * se + 1.0 / 12.0 * 0.5);
  EXPECT_LT(std::abs(frames / n), kSigmas * se + 1.0 / 12.0);
}

TEST(Scene, APartitionHidesTheDiscBehindIt) {
  WorldMap world = test_room();
  const auto plain = appearance_of(world, "contrast: 0, clutter_per_m2: 0");
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  const Scene scene(world, plain, 1);
  // Disc 1 at (9, 7, 1.6): behind the partition at x = 7 seen from the left, in sight from below.
  const auto grey_at_disc = [&](const Eigen::Isometry3d& wMc) {
    const Intrinsics k = camera(582);
    const auto uv = project(k, wMc.inverse() * Eigen::Vector3d(9, 7, 1.6));
    EXPECT_TRUE(uv && in_image(k, *uv, 2.0));
    unsigned char grey = 0;
    scene.expose(wMc, k, {}, clean)
        ->read_grey(
            {static_cast<int>(std::lround(uv->x())), static_cast<int>(std::lround(uv->y())), 1, 1},
            &grey, 1);
    return static_cast<int>(grey);
  };
  EXPECT_EQ(grey_at_disc(camera_at(9.5, 3.0, 85)), 60);
  EXPECT_EQ(grey_at_disc(camera_at(4.0, 5.8, 15)), 150);
}

TEST(Scene, AWallEdgeCutsADiscWhereTheRaysSay) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, "contrast: 0, clutter_per_m2: 0"), 1);
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  clean.blur_px = 0.0;
  // The partition's free edge (7, 5) covers the left half of disc 1's image.
  const Eigen::Vector2d disc(9.0, 7.0);
  const Eigen::Vector2d edge(7.0, 5.0);
  const Eigen::Vector2d eye = edge - 2.0 * (disc - edge).normalized();
  const Eigen::Isometry3d wMc = camera_at(eye.x(), eye.y(), 45);
  const Intrinsics k = camera(1500, 0.02);
  const auto frame = scene.expose(wMc, k, {}, clean);
  const auto image = imaging::grey_image(*frame);
  const auto centre = project(k, wMc.inverse() * Eigen::Vector3d(9, 7, 1.6));
  const auto row = static_cast<unsigned>(std::lround(centre->y()));
  const auto edge_column = static_cast<unsigned>(
      std::lround(project(k, wMc.inverse() * Eigen::Vector3d(7, 5, 1.6))->x()));
  int dark_left = 0;
  int dark_right = 0;
  for (unsigned u = edge_column - 60; u < edge_column + 60; ++u)
    if (image[row][u] == 60) (u < edge_column ? dark_left : dark_right) += 1;
  EXPECT_LE(dark_left, 1);
  EXPECT_GT(dark_right, 10);
}

TEST(Scene, TheBackgroundIsNeverEmpty) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, ""), 1);
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  for (int heading = 0; heading < 360; heading += 15) {
    for (const double tilt : {-60.0, 0.0, 50.0}) {
      const auto image = imaging::grey_image(
          *scene.expose(camera_at(4.0, 4.0, heading, tilt), camera(400, 0.1), {}, clean));
      for (unsigned i = 0; i < image.getSize(); ++i) ASSERT_GT(image.bitmap[i], 20);
    }
  }
}

}  // namespace
}  // namespace vigia::sim
