#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "vigia/evaluation/campaign.hpp"
#include "vigia/evaluation/drive_score.hpp"

namespace vigia::evaluation {

/// A mission that went badly.
struct WorstMission {
  CampaignTask task;
  mission::Outcome outcome = mission::Outcome::arrived;
  double position_max_m = 0.0;  ///< of the primary localizer
};

/// The @p count worst of a campaign, worst first: those that did not arrive before those that did,
/// each by the primary localizer's largest error.
std::vector<WorstMission> worst_missions(const std::vector<std::vector<DriveScore>>& scores,
                                         std::size_t count);

/// The command that repeats a mission; @p folder is the campaign's, "." from within it.
std::string repeat_command(const CampaignTask& task, const std::filesystem::path& folder);

/// A table for a terminal: outcome, error and command of each.
std::string worst_missions_text(const Campaign& campaign, const std::vector<WorstMission>& worst,
                                const std::filesystem::path& folder);

}  // namespace vigia::evaluation
