#pragma once

#include <string>
#include <vector>

#include "vigia/evaluation/campaign.hpp"
#include "vigia/evaluation/seed_statistics.hpp"

namespace vigia::evaluation {

/// A number of a drive that arms are compared by; of the primary localizer where it is one of a
/// localizer.
struct CampaignMetric {
  std::string key;    ///< in summary.json, unit included
  std::string label;  ///< in tables, unit included
  double factor;      ///< from the score's unit to the label's
  int digits;         ///< after the point, in tables
  double (*value)(const DriveScore& score);
};

const std::vector<CampaignMetric>& campaign_metrics();

/// An arm over its seeds. Intervals are 95 %: Student's t of means and paired differences,
/// Clopper–Pearson of shares, percentile bootstrap of the PCRLB ratio.
struct ArmStatistics {
  SeedStatistics over_seeds;
  std::vector<Estimate> means;        ///< in the order of campaign_metrics()
  std::vector<Estimate> differences;  ///< from the baseline, seed by seed; none of the baseline
};

/// @p scores[arm][seed], as scores_by_arm() has them.
std::vector<ArmStatistics> campaign_statistics(const Campaign& campaign,
                                               const std::vector<std::vector<DriveScore>>& scores);

}  // namespace vigia::evaluation
