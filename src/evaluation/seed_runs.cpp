#include "vigia/evaluation/seed_runs.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "vigia/mission/mission.hpp"

namespace vigia::evaluation {

std::vector<DriveScore> run_seeds(const mission::MissionSetup& setup, std::uint64_t first,
                                  int count, int threads,
                                  const std::function<void(const DriveScore&)>& done) {
  std::vector<DriveScore> scores(static_cast<std::size_t>(count));
  std::atomic<int> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (int i = next++; i < count; i = next++) {
        DriveScorer scorer;
        mission::run_mission(setup, first + static_cast<std::uint64_t>(i), {&scorer});
        scores[static_cast<std::size_t>(i)] = scorer.score();
        if (!done) continue;
        const std::lock_guard lock(mutex);
        done(scorer.score());
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> pool;
  for (int i = 1; i < std::min(threads, count); ++i) pool.emplace_back(work);
  work();
  for (auto& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
  return scores;
}

}  // namespace vigia::evaluation
