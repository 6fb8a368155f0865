#pragma once

#include <functional>
#include <map>
#include <vector>

#include "vigia/evaluation/campaign_journal.hpp"

namespace vigia::evaluation {

/// How far a campaign is.
struct CampaignProgress {
  std::size_t total = 0;
  std::size_t before = 0;  ///< finished when this process began
  std::size_t done = 0;    ///< finished now, those before included
};

/// Runs missions on @p threads threads; @p finished is called with each and its score, one call
/// at a time.
void run_missions(const Campaign& campaign, const std::vector<CampaignTask>& tasks, int threads,
                  const std::function<void(const CampaignTask&, const DriveScore&)>& finished);

/// Runs the missions that the journal lacks, seed by seed, on @p threads threads, and journals
/// each.
/// @p told is called at the beginning and after each mission, one call at a time.
void run_campaign(const Campaign& campaign, CampaignJournal& journal, int threads,
                  const std::function<void(const CampaignProgress&)>& told = {});

/// The scores of a finished campaign: [arm][seed], whatever the order in which they finished.
std::vector<std::vector<DriveScore>> scores_by_arm(const Campaign& campaign,
                                                   std::map<CampaignTask, DriveScore> finished);

}  // namespace vigia::evaluation
