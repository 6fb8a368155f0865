// How many times faster than real time a whole mission runs: with only the windows that the tracker
// asks for, and with every pixel of every frame computed. `full_frame_ms` is what one frame costs
// alone: 1 / (25 Hz · full_frame_ms) bounds the second figure from above.

#include <chrono>
#include <filesystem>

#include <benchmark/benchmark.h>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"
#include "vigia/mission/run_folder.hpp"

namespace {

using namespace vigia;

const std::string kMission = std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml";

double full_frame_ms(const mission::MissionSetup& setup) {
  const sim::Simulator simulator(setup.robot, setup.world, setup.appearance, setup.start, 1);
  constexpr int kFrames = 50;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kFrames; ++i)
    benchmark::DoNotOptimize(imaging::grey_image(*simulator.expose()));
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  return spent.count() / kFrames;
}

void run(benchmark::State& state, bool full_frames) {
  auto setup = mission::load_mission(kMission);
  setup.full_frames = full_frames;
  setup.recorded_frames = 0;
  const auto folder = std::filesystem::temp_directory_path() / "vigia-bench-mission";
  double simulated = 0.0;
  std::uint64_t seed = 1;
  for (auto _ : state) {
    evaluation::DriveScorer scorer;
    mission::RunFolder recorder(folder);
    mission::run_mission(setup, seed++, {&scorer, &recorder});
    simulated += scorer.score().sim_s;
  }
  state.counters["real_time_factor"] = benchmark::Counter(simulated, benchmark::Counter::kIsRate);
  state.counters["full_frame_ms"] = full_frame_ms(setup);
}

void mission_with_windows(benchmark::State& state) {
  run(state, false);
}
void mission_with_full_frames(benchmark::State& state) {
  run(state, true);
}

BENCHMARK(mission_with_windows)->Unit(benchmark::kMillisecond);
BENCHMARK(mission_with_full_frames)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
