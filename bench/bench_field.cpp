// A frame of 50 points on the 12 × 8 m field: refinement while tracked, the global match from the
// frame alone without goals, MUREA, and an update of 500 particles.

#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "vigia/evaluation/field_frames.hpp"
#include "vigia/localization/field_match.hpp"
#include "vigia/localization/field_posterior.hpp"
#include "vigia/localization/field_refine.hpp"
#include "vigia/localization/mcl.hpp"
#include "vigia/localization/murea.hpp"

namespace {

using namespace vigia;

constexpr std::size_t kFrames = 64;

struct Frames {
  FieldMap map;
  std::vector<evaluation::FieldFrame> frames;

  explicit Frames(bool goals) {
    MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/fields/12x8.yaml"), "field");
    map = read_field_map(reader.map("field"));
    RandomStream random(1, "bench");
    evaluation::FieldFrameParams params;
    params.goals = goals;
    params.clutter_share = 0.25;
    for (std::size_t i = 0; i < kFrames; ++i)
      frames.push_back(evaluation::draw_field_frame(
          map, params, evaluation::random_field_pose(map, 0.3, random), random));
  }
};

Pose2 start_near(const evaluation::FieldFrame& frame) {
  Pose2 start = frame.truth;
  start.x += 0.03;
  start.theta += 0.01;
  return start;
}

void BM_RefineTracked(benchmark::State& state) {
  const Frames frames(false);
  const localization::FieldModel model(frames.map);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& frame = frames.frames[i++ % kFrames];
    benchmark::DoNotOptimize(
        localization::refine_field_pose(model, frame.scan.points, start_near(frame)));
  }
}
BENCHMARK(BM_RefineTracked)->Unit(benchmark::kMillisecond);

/// The same with the scan's straight groups and the moments of the posterior.
void BM_PosteriorTracked(benchmark::State& state) {
  const Frames frames(false);
  const localization::FieldModel model(frames.map);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& frame = frames.frames[i++ % kFrames];
    const auto fix = localization::refine_field_pose(model, frame.scan.points, start_near(frame));
    benchmark::DoNotOptimize(
        localization::posterior_about(model, frame.scan.points, model.groups_of(frame.scan), fix));
  }
}
BENCHMARK(BM_PosteriorTracked)->Unit(benchmark::kMillisecond);

void BM_GlobalMatch(benchmark::State& state) {
  const Frames frames(false);
  const localization::FieldModel model(frames.map);
  const localization::FieldMatcher matcher(model);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(matcher.match(frames.frames[i++ % kFrames].scan));
}
BENCHMARK(BM_GlobalMatch)->Unit(benchmark::kMillisecond);

void BM_MureaGlobal(benchmark::State& state) {
  const Frames frames(true);
  const localization::FieldModel model(frames.map);
  const localization::Murea murea(model);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(murea.locate(frames.frames[i++ % kFrames].scan));
}
BENCHMARK(BM_MureaGlobal)->Unit(benchmark::kMillisecond);

/// Updates of 500 particles at a robot that stands; no image suggests poses.
void BM_MclUpdate(benchmark::State& state) {
  const Frames frames(true);
  const localization::FieldModel model(frames.map);
  localization::MclParams params;
  params.max_particles = 500;
  params.check_every = 1 << 30;
  localization::Mcl mcl(model, params, 1);
  RandomStream random(2, "bench");
  const Pose2 truth{1.0, 1.0, 0.5};
  mcl.reset({}, Prior{truth, Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal()});
  std::vector<evaluation::FieldFrame> stood;
  for (std::size_t i = 0; i < kFrames; ++i)
    stood.push_back(evaluation::draw_field_frame(frames.map, {}, truth, random));
  std::size_t i = 0;
  for (auto _ : state) {
    mcl.predict({{}, {}, 0.0, 1e-3, 0.0});
    mcl.update(stood[i++ % kFrames].scan);
  }
  state.counters["particles/s"] =
      benchmark::Counter(500.0 * static_cast<double>(i), benchmark::Counter::kIsRate);
}
BENCHMARK(BM_MclUpdate)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
