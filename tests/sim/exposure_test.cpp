#include "vigia/sim/exposure.hpp"

#include "sim/room.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"
#include "vigia/sim/simulator.hpp"

namespace vigia::sim {
namespace {

using imaging::Window;

Person somebody(double x, double y) {
  Person person;
  person.position = {x, y};
  person.walking = true;
  person.walked_m = 0.4;
  return person;
}

/// A camera that turns, people about, uneven light.
Exposure awkward(int instants) {
  Exposure exposure;
  for (int i = 0; i < instants; ++i)
    exposure.instants.push_back(
        {camera_at(1.5, 3.0, 5.0 + 0.1 * i), {somebody(4.0, 3.4), somebody(2.6, 2.5)}});
  exposure.light = LightField({}, test_room().plan, 4).at(Stamp::from_seconds(20.0));
  return exposure;
}

TEST(Exposure, AWindowEqualsTheCropWithBlurLightAndPeople) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, "clutter_per_m2: 1"), 3);
  RandomStream random(1, "windows");
  const Intrinsics k = camera(582, 0.06);
  for (const int instants : {1, 5}) {
    const Exposure exposure = awkward(instants);
    const auto full = imaging::grey_image(*scene.expose(exposure, k, {7}, {}));
    for (int i = 0; i < 15; ++i) {
      Window window;
      window.u = static_cast<int>(random.index(639));
      window.v = static_cast<int>(random.index(479));
      window.width = 1 + static_cast<int>(random.index(static_cast<std::size_t>(640 - window.u)));
      window.height = 1 + static_cast<int>(random.index(static_cast<std::size_t>(480 - window.v)));
      std::vector<unsigned char> pixels(static_cast<std::size_t>(window.width * window.height));
      scene.expose(exposure, k, {7}, {})->read_grey(window, pixels.data(), window.width);
      for (int row = 0; row < window.height; ++row)
        ASSERT_TRUE(std::equal(pixels.begin() + row * window.width,
                               pixels.begin() + (row + 1) * window.width,
                               full[static_cast<unsigned>(window.v + row)] + window.u))
            << "row " << row << " of window at " << window.u << ", " << window.v;
    }
  }
}

TEST(Exposure, AColourWindowEqualsTheCropToo) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, ""), 3);
  ImagingParams params;
  params.colour = true;
  const Exposure exposure = awkward(3);
  const auto full = imaging::colour_image(*scene.expose(exposure, camera(582), {7}, params));
  const Window window{211, 103, 157, 99};
  std::vector<vpRGBa> pixels(static_cast<std::size_t>(window.width * window.height));
  scene.expose(exposure, camera(582), {7}, params)
      ->read_colour(window, pixels.data(), window.width);
  for (int row = 0; row < window.height; ++row)
    for (int column = 0; column < window.width; ++column)
      ASSERT_TRUE(
          pixels[static_cast<std::size_t>(row * window.width + column)] ==
          full[static_cast<unsigned>(window.v + row)][static_cast<unsigned>(window.u + column)]);
}

TEST(MotionBlur, IsTheMeanOfTheInstantsWithTheNoiseOfOne) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, "light: 0.7"), 3);  // nothing near 255
  const Intrinsics k = camera(582);
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  const Exposure exposure = awkward(4);
  const auto blurred = imaging::grey_image(*scene.expose(exposure, k, {7}, clean));
  const auto noisy = imaging::grey_image(*scene.expose(exposure, k, {7}, {}));
  std::vector<double> mean(blurred.getSize(), 0.0);
  for (const auto& instant : exposure.instants) {
    const auto sharp =
        imaging::grey_image(*scene.expose({{instant}, exposure.light}, k, {7}, clean));
    for (unsigned i = 0; i < sharp.getSize(); ++i) mean[i] += 0.25 * sharp.bitmap[i];
  }
  double square = 0.0;
  for (unsigned i = 0; i < blurred.getSize(); ++i) {
    // Each of the pictures is rounded.
    ASSERT_NEAR(blurred.bitmap[i], mean[i], 1.01);
    square += std::pow(1.0 * noisy.bitmap[i] - blurred.bitmap[i], 2);
  }
  constexpr double kSigmas = 4.5;
  const double n = blurred.getSize();
  EXPECT_NEAR(square / n, 16.0 + 1.0 / 12.0, kSigmas * 16.0 * std::sqrt(2.0 / n) + 1.0 / 12.0);
}

RobotSetup robot_setup() {
  ImagingParams imaging;
  imaging.noise_sigma = 0.0;
  RobotSetup setup = pan_tilt_zoom_robot(
      usual_robot(), ZoomCalibration(640, 480, 319.5, 239.5, {{8, 582, 0.0}, {48, 3490, 0.0}}),
      imaging);
  setup.robot.sensor = {0.0, 0.0, 0.0};
  return setup;
}

TEST(MotionBlur, SpreadsAnEdgeOverTheWayThatItGoesDuringTheExposure) {
  const WorldMap world = test_room();
  const auto plain = appearance_of(world, "contrast: 0, clutter_per_m2: 0");
  DisturbanceParams disturbances;
  disturbances.motion_blur.emplace();
  // The head pans over disc 3 at (0, 4), seen from (4, 4).
  const auto shot = [&](const DisturbanceParams& on) {
    Simulator simulator(robot_setup(), world, plain, {4.0, 4.0, kPi}, 1, on);
    simulator.robot().command({}, {{1.0, 0.0}, 0.0});
    simulator.advance(Duration::from_seconds(0.16));
    return imaging::grey_image(*simulator.expose());
  };
  const auto sharp = shot({});
  const auto blurred = shot(disturbances);
  // In the row that shows most of the disc: how many pixels lie between disc and wall.
  const auto between = [](const vpImage<unsigned char>& image) {
    int widest = 0;
    int edge = 0;
    for (unsigned v = 0; v < 480; ++v) {
      int disc = 0;
      int ramp = 0;
      for (unsigned u = 0; u < 640; ++u) {
        if (image[v][u] < 62) ++disc;
        if (image[v][u] > 65 && image[v][u] < 145) ++ramp;
      }
      if (disc <= widest) continue;
      widest = disc;
      edge = ramp;
    }
    EXPECT_GT(widest, 15);
    return edge;
  };
  // 5.8 px of way; the floor and the boxes do not reach that row.
  EXPECT_GE(between(blurred), between(sharp) + 2);
}

TEST(MotionBlur, LeavesTheFramesOfARobotThatStandsStillAlone) {
  const WorldMap world = test_room();
  DisturbanceParams disturbances;
  disturbances.motion_blur.emplace();
  const Simulator still(robot_setup(), world, nullptr, {4.0, 4.0, kPi}, 1, disturbances);
  const Simulator plain(robot_setup(), world, nullptr, {4.0, 4.0, kPi}, 1);
  EXPECT_TRUE(imaging::grey_image(*still.expose()) == imaging::grey_image(*plain.expose()));
}

TEST(Light, RunsFromTheLeastToTheMostGainOverTheRoom) {
  const FloorPlan plan = test_room().plan;
  LightParams params;
  params.drift = 0.0;
  params.step_every_s = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const LightNow light = LightField(params, plan, seed).at({});
    double least = 9.0;
    double most = 0.0;
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; j <= 35; ++j) {
        for (const double z : {0.0, 1.4, 2.8}) {
          const double gain = light.gain({0.2 * i, 0.2 * j, z});
          least = std::min(least, gain);
          most = std::max(most, gain);
        }
      }
    }
    EXPECT_NEAR(least, 0.75, 0.02);
    EXPECT_NEAR(most, 1.25, 0.02);
  }
}

TEST(Light, DriftsSlowlyAndStepsWithItsLamps) {
  const FloorPlan plan = test_room().plan;
  LightParams steady;
  steady.step_every_s = 0.0;
  const LightField drifting(steady, plan, 3);
  const double start = drifting.at({}).ambient;
  for (int t = 1; t < 600; ++t) {
    const double gain = drifting.at(Stamp::from_seconds(t)).ambient;
    EXPECT_NEAR(gain / drifting.at(Stamp::from_seconds(t - 1)).ambient, 1.0, 0.02);
    EXPECT_NEAR(gain / start, 1.0, 0.2 / 0.9 + 1e-9);
  }
  LightParams stepping;
  stepping.drift = 0.0;
  const LightField field(stepping, plan, 3);
  ASSERT_FALSE(field.steps().empty());
  const Stamp step = field.steps().front();
  const auto sum = [&](Stamp stamp) {
    double strength = 0.0;
    for (const auto& lamp : field.at(stamp).lamps) strength += lamp.strength;
    return strength;
  };
  EXPECT_LT(sum(step), sum(step - Duration{1}));
}

TEST(Light, APixelsGainIsThatOfTheThingThatItShows) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, "contrast: 0, clutter_per_m2: 0"), 1);
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  const Intrinsics k = camera(582, 0.06);
  Exposure exposure;
  exposure.instants.push_back({camera_at(9.5, 3.0, 85), {}});
  const auto even = imaging::grey_image(*scene.expose(exposure, k, {}, clean));
  exposure.light = LightField({}, world.plan, 5).at(Stamp::from_seconds(10));
  const auto lit = imaging::grey_image(*scene.expose(exposure, k, {}, clean));
  const Eigen::Isometry3d cMw = exposure.instants.front().wMc.inverse();
  for (double x = 8.0; x <= 11.0; x += 0.25) {
    for (const double z : {0.6, 1.2, 2.0}) {
      const Eigen::Vector3d p(x, 7.0, z);
      const auto uv = project(k, cMw * p);
      if (!uv || !in_image(k, *uv, 3.0)) continue;
      const auto u = static_cast<unsigned>(std::lround(uv->x()));
      const auto v = static_cast<unsigned>(std::lround(uv->y()));
      EXPECT_NEAR(lit[v][u], even[v][u] * exposure.light->gain(p), 1.5) << x << ", " << z;
    }
  }
}

TEST(People, HideTheDiscBehindThemAndNothingElse) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, "contrast: 0, clutter_per_m2: 0"), 1);
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  const Intrinsics k = camera(582);
  const auto picture = [&](const std::vector<Person>& people) {
    return imaging::grey_image(
        *scene.expose(Exposure{{{camera_at(9.0, 3.0, 90), people}}, std::nullopt}, k, {}, clean));
  };
  const auto standing = [](double x, double y) {
    Person person = somebody(x, y);
    person.walking = false;
    person.heading = from_deg(90);
    return person;
  };
  const auto empty = picture({});
  // Disc 1 hangs at (9, 7, 1.6): a neck at 2 m hides it. One stands before it, one beside it.
  const auto before = picture({standing(9.0, 5.0)});
  const auto beside = picture({standing(10.2, 5.0)});
  const auto uv = project(k, camera_at(9.0, 3.0, 90).inverse() * Eigen::Vector3d(9.0, 7.0, 1.6));
  const auto u = static_cast<unsigned>(std::lround(uv->x()));
  const auto v = static_cast<unsigned>(std::lround(uv->y()));
  EXPECT_EQ(empty[v][u], 60);
  EXPECT_NE(before[v][u], 60);
  EXPECT_EQ(beside[v][u], 60);
  // The body is as wide and as high as stated: at 2 m, 582 px/m · 1/2.
  unsigned left = 640;
  unsigned right = 0;
  unsigned top = 480;
  for (unsigned row = 0; row < 480; ++row) {
    for (unsigned column = 0; column < 640; ++column) {
      if (before[row][column] == empty[row][column]) continue;
      left = std::min(left, column);
      right = std::max(right, column);
      top = std::min(top, row);
    }
  }
  EXPECT_GT(right - left, 0.3 * 291);
  EXPECT_LE(right - left, 0.5 * 291 / 0.87);
  EXPECT_NEAR(top, 239.5 - (1.75 - 1.2) * 291, 6.0);
}

TEST(People, AWallHidesSomebodyBehindIt) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, ""), 1);
  const auto picture = [&](const std::vector<Person>& people) {
    return imaging::grey_image(*scene.expose(
        Exposure{{{camera_at(4.0, 6.2, 0), people}}, std::nullopt}, camera(582), {}, {}));
  };
  // The partition stands at x = 7 from y = 5 to 7.
  EXPECT_TRUE(picture({}) == picture({somebody(8.5, 6.2)}));
  EXPECT_FALSE(picture({}) == picture({somebody(5.5, 6.2)}));
}

}  // namespace
}  // namespace vigia::sim
