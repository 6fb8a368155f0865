#include "vigia/evaluation/campaign_run.hpp"

#include "work_queue.hpp"

#include <mutex>

#include "vigia/mission/mission.hpp"

namespace vigia::evaluation {
namespace {

/// Seed by seed: stopped early, every arm has as many drives as the others, give or take one.
std::vector<CampaignTask> tasks_left(const Campaign& campaign, const CampaignJournal& journal) {
  std::vector<CampaignTask> tasks;
  for (int i = 0; i < campaign.seeds; ++i)
    for (std::size_t arm = 0; arm < campaign.arms.size(); ++arm) {
      const CampaignTask task{arm, campaign.first_seed + static_cast<std::uint64_t>(i)};
      if (journal.finished().count(task) == 0) tasks.push_back(task);
    }
  return tasks;
}

}  // namespace

void run_campaign(const Campaign& campaign, CampaignJournal& journal, int threads,
                  const std::function<void(const CampaignProgress&)>& told) {
  const auto tasks = tasks_left(campaign, journal);
  const std::size_t before = campaign.missions() - tasks.size();
  CampaignProgress progress{campaign.missions(), before, before};
  if (told) told(progress);
  std::mutex mutex;
  work_off(tasks.size(), threads, [&](std::size_t i) {
    DriveScorer scorer;
    mission::run_mission(campaign.arms[tasks[i].arm].setup, tasks[i].seed, {&scorer});
    const std::lock_guard lock(mutex);
    journal.append(tasks[i], scorer.score());
    ++progress.done;
    if (told) told(progress);
  });
}

std::vector<std::vector<DriveScore>> scores_by_arm(const Campaign& campaign,
                                                   const CampaignJournal& journal) {
  std::vector<std::vector<DriveScore>> scores(campaign.arms.size());
  for (std::size_t arm = 0; arm < scores.size(); ++arm)
    for (int i = 0; i < campaign.seeds; ++i)
      scores[arm].push_back(
          journal.finished().at({arm, campaign.first_seed + static_cast<std::uint64_t>(i)}));
  return scores;
}

}  // namespace vigia::evaluation
