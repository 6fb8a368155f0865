#pragma once

#include <string>
#include <vector>

#include "vigia/evaluation/campaign_statistics.hpp"

namespace vigia::evaluation {

/// results.csv: a row for each arm, seed and localizer.
std::string campaign_csv(const Campaign& campaign,
                         const std::vector<std::vector<DriveScore>>& scores);

/// summary.json of a campaign.
std::string campaign_json(const Campaign& campaign, const std::vector<ArmStatistics>& statistics);

/// The arms and their differences from the baseline, as tables for a terminal.
std::string campaign_text(const Campaign& campaign, const std::vector<ArmStatistics>& statistics);

/// The same in Markdown.
std::string campaign_markdown(const Campaign& campaign,
                              const std::vector<ArmStatistics>& statistics);

}  // namespace vigia::evaluation
