// Cost of the simulated camera, beside the time that a copy of the frame takes and beside the
// usual way with OpenCV (warp one textured plane, add Gaussian noise).
#include <cmath>
#include <cstring>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "vigia/core/config.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/sim/scene.hpp"

namespace {

using namespace vigia;

constexpr std::int64_t kTick = 40'000'000;

WorldMap room() {
  WorldMap world;
  world.plan = FloorPlan({{0, 0}, {12, 0}, {12, 7}, {0, 7}}, 2.8, {Wall{{7, 7}, {7, 5}, 2.8}},
                         {Obstacle{{{5, 2.2}, {6.2, 2.2}, {6.2, 3.0}, {5, 3.0}}, 0.8}});
  std::vector<Landmark> landmarks(3);
  const Eigen::Vector3d centres[] = {{12, 3, 1.7}, {4, 7, 1.6}, {9, 0, 1.5}};
  const double normals[] = {180.0, -90.0, 90.0};
  for (int i = 0; i < 3; ++i) {
    Landmark& landmark = landmarks[static_cast<std::size_t>(i)];
    landmark.id = i;
    landmark.wMl = wall_mount(centres[i], from_deg(normals[i]));
  }
  world.landmarks = LandmarkMap(landmarks);
  return world;
}

sim::Scene scene() {
  const WorldMap world = room();
  MapReader reader(parse_config("version: 1\n", "bench"), "world");
  return {world, sim::read_appearance(reader, world), 1};
}

/// A view of the whole room from a corner.
Eigen::Isometry3d room_view() {
  return to_isometry(Pose2{1.5, 2.0, from_deg(10)}) * camera_in_base({}, {0.0, from_deg(-5)});
}

/// Before disc 2, at a distance at which its image has the radius range(0) at f = 700 px.
Eigen::Isometry3d disc_view(double radius_px) {
  return to_isometry(Pose2{9.0, 700.0 * 0.1 / radius_px + 0.15, from_deg(-90)}) *
         camera_in_base({}, {0.0, std::atan2(0.5, 700.0 * 0.1 / radius_px)});
}

Intrinsics lens() {
  Intrinsics intrinsics;
  intrinsics.kdu = 0.05;
  return intrinsics;
}

void render(benchmark::State& state, const Eigen::Isometry3d& wMc, const imaging::Window& window) {
  const sim::Scene world = scene();
  std::vector<unsigned char> pixels(static_cast<std::size_t>(window.width * window.height));
  std::int64_t stamp = 0;
  for (auto _ : state) {
    const auto frame = world.expose(wMc, lens(), {stamp += kTick}, {});
    frame->read_grey(window, pixels.data(), window.width);
    benchmark::DoNotOptimize(pixels.data());
  }
}

void full_frame(benchmark::State& state) {
  render(state, room_view(), {0, 0, 640, 480});
}
void window_100(benchmark::State& state) {
  render(state, room_view(), {270, 300, 100, 100});
}
void window_100_with_disc(benchmark::State& state) {
  render(state, disc_view(static_cast<double>(state.range(0))), {270, 190, 100, 100});
}
void full_frame_with_disc(benchmark::State& state) {
  render(state, disc_view(static_cast<double>(state.range(0))), {0, 0, 640, 480});
}

void expose_alone(benchmark::State& state) {
  const sim::Scene world = scene();
  std::int64_t stamp = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(world.expose(room_view(), lens(), {stamp += kTick}, {}));
}

void copy_of_a_frame(benchmark::State& state) {
  std::vector<unsigned char> from(640 * 480, 7);
  std::vector<unsigned char> to(from.size());
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), from.size());
    benchmark::DoNotOptimize(to.data());
  }
}

void opencv_warp_and_randn(benchmark::State& state) {
  cv::setNumThreads(1);
  cv::Mat texture(1024, 1024, CV_8UC1);
  cv::randu(texture, 0, 255);
  const cv::Matx33d H(0.6, 0.05, 3.0, -0.02, 0.5, 8.0, 1e-5, 2e-5, 1.0);
  cv::Mat warped(480, 640, CV_8UC1);
  cv::Mat noise(480, 640, CV_16SC1);
  cv::Mat noisy;
  for (auto _ : state) {
    cv::warpPerspective(texture, warped, H, warped.size(), cv::INTER_LINEAR);
    cv::randn(noise, 0, 4);
    cv::add(warped, noise, noisy, cv::noArray(), CV_8UC1);
    benchmark::DoNotOptimize(noisy.data);
  }
}

// Bounds: full frame 2.5 ms, window 0.12 ms, a disc of r = 24 px 0.05 ms more, expose 0.005 ms.
BENCHMARK(full_frame)->Unit(benchmark::kMillisecond)->Name("full frame 640x480 (bound 2.5 ms)");
BENCHMARK(window_100)->Unit(benchmark::kMicrosecond)->Name("window 100x100 (bound 120 us)");
BENCHMARK(window_100_with_disc)
    ->Unit(benchmark::kMicrosecond)
    ->Arg(24)
    ->Name("window 100x100 with a disc of r px (bound 120+50 us)");
BENCHMARK(full_frame_with_disc)
    ->Unit(benchmark::kMillisecond)
    ->Arg(24)
    ->Arg(150)
    ->Name("full frame with a disc of r px");
BENCHMARK(expose_alone)->Unit(benchmark::kMicrosecond)->Name("expose alone (bound 5 us)");
BENCHMARK(copy_of_a_frame)->Unit(benchmark::kMicrosecond)->Name("peer: memcpy of a frame");
BENCHMARK(opencv_warp_and_randn)
    ->Unit(benchmark::kMillisecond)
    ->Name("peer: warpPerspective of one plane and randn");

}  // namespace

BENCHMARK_MAIN();
