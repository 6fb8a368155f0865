#include "vigia/evaluation/campaign_run.hpp"

#include "work_queue.hpp"

#include <mutex>
#include <utility>

#include "vigia/mission/mission.hpp"

namespace vigia::evaluation {
namespace {

std::vector<CampaignTask> tasks_left(const Campaign& campaign, const CampaignJournal& journal) {
  std::vector<CampaignTask> tasks;
  for (std::size_t number = 0; number < campaign.missions(); ++number)
    if (journal.finished().count(campaign.task(number)) == 0)
      tasks.push_back(campaign.task(number));
  return tasks;
}

}  // namespace

void run_missions(const Campaign& campaign, const std::vector<CampaignTask>& tasks, int threads,
                  const std::function<void(const CampaignTask&, const DriveScore&)>& finished) {
  std::mutex mutex;
  work_off(tasks.size(), threads, [&](std::size_t i) {
    DriveScorer scorer;
    mission::run_mission(campaign.arms[tasks[i].arm].setup, tasks[i].seed, {&scorer});
    const std::lock_guard lock(mutex);
    finished(tasks[i], scorer.score());
  });
}

void run_campaign(const Campaign& campaign, CampaignJournal& journal, int threads,
                  const std::function<void(const CampaignProgress&)>& told) {
  const auto tasks = tasks_left(campaign, journal);
  const std::size_t before = campaign.missions() - tasks.size();
  CampaignProgress progress{campaign.missions(), before, before};
  if (told) told(progress);
  run_missions(campaign, tasks, threads, [&](const CampaignTask& task, const DriveScore& score) {
    journal.append(task, score);
    ++progress.done;
    if (told) told(progress);
  });
}

std::vector<std::vector<DriveScore>> scores_by_arm(const Campaign& campaign,
                                                   std::map<CampaignTask, DriveScore> finished) {
  std::vector<std::vector<DriveScore>> scores(campaign.arms.size());
  for (std::size_t number = 0; number < campaign.missions(); ++number) {
    const CampaignTask task = campaign.task(number);
    scores[task.arm].push_back(std::move(finished.at(task)));
  }
  return scores;
}

}  // namespace vigia::evaluation
