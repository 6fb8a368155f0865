// Cost of a mirror camera's picture of a field, whole and along the rays of a radial scan, beside
// the same picture of an empty hall, which has no paint, goals, boards or people. Argument: 0 the
// field, 1 the empty hall.
#include "sim/soccer.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "vigia/core/config.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/sim/scene.hpp"

namespace {

using namespace vigia;

constexpr std::int64_t kFrame = 40'000'000;

sim::Scene scene_of(bool empty) {
  MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/worlds/field-12x8.yaml"), "world");
  WorldMap world = read_world_map(reader);
  if (!empty) return {world, sim::read_appearance(reader, world), 1};
  world.field.reset();
  return {world, nullptr, 1};
}

sim::Exposure exposure_of(bool empty) {
  sim::Exposure exposure{{{Eigen::Isometry3d(Eigen::Translation3d(-2.0, 1.0, 0.75)), {}}}, {}};
  exposure.instants.front().wMc.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  for (int i = 0; i < 6 && !empty; ++i) {
    sim::Person& figure = exposure.instants.front().people.emplace_back();
    figure.figure = i == 0 ? sim::Figure::chassis : sim::Figure::robot;
    figure.height_m = i == 0 ? 0.5 : 0.8;
    figure.position = Eigen::Vector2d(-2.0, 1.0);
    if (i > 0) figure.position += (1.0 + 0.4 * i) * Eigen::Vector2d(std::cos(i), std::sin(i));
  }
  return exposure;
}

/// The pixels of 120 rays, two beside one another at each step.
std::vector<imaging::Run> scan_runs() {
  std::set<std::pair<int, int>> pixels;
  for (int ray = 0; ray < 120; ++ray) {
    const double u = std::cos(from_deg(3.0 * ray));
    const double v = std::sin(from_deg(3.0 * ray));
    const double step = 1.0 / std::max(std::abs(u), std::abs(v));
    for (double r = 85.0; r < 204.0; r += step) {
      const int column = static_cast<int>(std::floor(319.5 + r * u));
      const int row = static_cast<int>(std::floor(239.5 + r * v));
      const bool across = std::abs(u) < std::abs(v);
      pixels.insert({row, column});
      pixels.insert({row + (across ? 0 : 1), column + (across ? 1 : 0)});
    }
  }
  std::vector<imaging::Run> runs;
  for (const auto& [v, u] : pixels) {
    if (!runs.empty() && runs.back().v == v && runs.back().u_end == u)
      ++runs.back().u_end;
    else
      runs.push_back({v, u, u + 1});
  }
  return runs;
}

sim::ImagingParams in_colour() {
  sim::ImagingParams params;
  params.colour = true;
  return params;
}

void full_mirror_frame(benchmark::State& state) {
  const bool empty = state.range(0) != 0;
  const sim::Scene scene = scene_of(empty);
  const sim::Exposure exposure = exposure_of(empty);
  std::vector<vpRGBa> pixels(640 * 480);
  Stamp stamp;
  for (auto _ : state) {
    const auto frame =
        scene.expose(exposure, sim::soccer_mirror(), {stamp.ns += kFrame}, in_colour());
    frame->read_colour(frame->full(), pixels.data(), 640);
    benchmark::DoNotOptimize(pixels.data());
  }
}

void mirror_scan(benchmark::State& state) {
  const bool empty = state.range(0) != 0;
  const sim::Scene scene = scene_of(empty);
  const sim::Exposure exposure = exposure_of(empty);
  const std::vector<imaging::Run> runs = scan_runs();
  std::vector<vpRGBa> pixels(imaging::pixels_in(runs));
  Stamp stamp;
  for (auto _ : state) {
    const auto frame =
        scene.expose(exposure, sim::soccer_mirror(), {stamp.ns += kFrame}, in_colour());
    frame->read_colour_runs(runs, pixels.data());
    benchmark::DoNotOptimize(pixels.data());
  }
  state.counters["pixels"] = static_cast<double>(pixels.size());
}

BENCHMARK(full_mirror_frame)
    ->Unit(benchmark::kMillisecond)
    ->Arg(0)
    ->Arg(1)
    ->Name("mirror frame 640x480 in colour (bound 10 ms)");
BENCHMARK(mirror_scan)
    ->Unit(benchmark::kMillisecond)
    ->Arg(0)
    ->Arg(1)
    ->Name("runs of a radial scan (bound 1 ms)");

}  // namespace

BENCHMARK_MAIN();
