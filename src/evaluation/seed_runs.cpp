#include "vigia/evaluation/seed_runs.hpp"

#include "work_queue.hpp"

#include <mutex>

#include "vigia/mission/mission.hpp"

namespace vigia::evaluation {

std::vector<DriveScore> run_seeds(const mission::MissionSetup& setup, std::uint64_t first,
                                  int count, int threads,
                                  const std::function<void(const DriveScore&)>& done) {
  std::vector<DriveScore> scores(static_cast<std::size_t>(count));
  std::mutex mutex;
  work_off(scores.size(), threads, [&](std::size_t i) {
    DriveScorer scorer;
    mission::run_mission(setup, first + i, {&scorer});
    scores[i] = scorer.score();
    if (!done) return;
    const std::lock_guard lock(mutex);
    done(scores[i]);
  });
  return scores;
}

}  // namespace vigia::evaluation
