#pragma once

#include <string>
#include <vector>

#include "vigia/evaluation/campaign_statistics.hpp"
#include "vigia/evaluation/worst_missions.hpp"

namespace vigia::evaluation {

/// results.csv: a row for each arm, seed and localizer.
std::string campaign_csv(const Campaign& campaign,
                         const std::vector<std::vector<DriveScore>>& scores);

/// summary.json of a campaign. @p programs: versions that its missions were driven by, where they
/// are several.
std::string campaign_json(const Campaign& campaign, const std::vector<ArmStatistics>& statistics,
                          const std::vector<WorstMission>& worst,
                          const std::vector<std::string>& programs = {});

/// The arms and their differences from the baseline, as tables for a terminal.
std::string campaign_text(const Campaign& campaign, const std::vector<ArmStatistics>& statistics);

/// The same in Markdown.
std::string campaign_markdown(const Campaign& campaign,
                              const std::vector<ArmStatistics>& statistics);

}  // namespace vigia::evaluation
