// Colour patterns and tags at 640×480: cold in a full frame with clutter, and tracked from frame to
// frame, without the rendering.

#include "tracking/pattern_views.hpp"

#include <array>
#include <memory>

#include <benchmark/benchmark.h>
#include <opencv2/core/utility.hpp>

namespace {

using namespace vigia;
using namespace vigia::tracking;
using namespace vigia::tracking::testing;

/// Eight frames of a slowly moving landmark, computed beforehand.
struct Sequence {
  Sequence(const decltype(Landmark::shape)& shape, double reach_m, double reach_px)
      : hall(shape, "clutter_per_m2: 2") {
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const double phase = 2.0 * 3.14159265358979323846 * static_cast<double>(k) / 8.0;
      Intrinsics intrinsics;
      intrinsics.px = intrinsics.py = reach_px * 3.0 / reach_m;
      const Eigen::Isometry3d wMc =
          look_at(hall.landmark(), 3.0, 0.7, 0.3, 0.1,
                  1.5 * Eigen::Vector2d(std::cos(phase), std::sin(phase)), intrinsics);
      frames[k] = std::make_unique<imaging::ImageFrame>(
          hall.picture(wMc, intrinsics, colour_params(), static_cast<std::int64_t>(k)));
    }
  }
  LandmarkHall hall;
  std::array<std::unique_ptr<imaging::ImageFrame>, 8> frames;
};

const Sequence& pattern_sequence() {
  static const Sequence sequence(pattern_of({7, 42, 5}), 0.125, 190.0);
  return sequence;
}

const Sequence& tag_sequence() {
  static const Sequence sequence(TagShape{17, 0.2}, 0.1, 60.0);
  return sequence;
}

void cold(benchmark::State& state, const char* name, const Sequence& (*sequence)()) {
  const auto tracker = make_point_tracker(name, {});
  std::size_t k = 0;
  std::size_t missed = 0;
  for (auto _ : state) {
    k = (k + 1) % 8;
    const auto found = tracker->find_all(*sequence().frames[k]);
    missed += found.size() == 1 && found[0].status == FeatureStatus::found ? 0 : 1;
  }
  state.counters["missed"] = static_cast<double>(missed);
}
BENCHMARK_CAPTURE(cold, pattern, "pattern", &pattern_sequence)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cold, tag, "tag", &tag_sequence)->Unit(benchmark::kMillisecond);

void tracked(benchmark::State& state, const char* name, const Sequence& (*sequence)()) {
  const auto tracker = make_point_tracker(name, {});
  const auto first = tracker->find_all(*sequence().frames[0]);
  if (first.size() != 1) return state.SkipWithError("the landmark is not found");
  tracker->start(*sequence().frames[0], first[0]);
  std::size_t k = 0;
  int lost = 0;
  for (auto _ : state) {
    k = (k + 1) % 8;
    lost += tracker->track(*sequence().frames[k]).status == FeatureStatus::found ? 0 : 1;
  }
  state.counters["lost"] = lost;
}
BENCHMARK_CAPTURE(tracked, pattern, "pattern", &pattern_sequence)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tracked, tag, "tag", &tag_sequence)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
