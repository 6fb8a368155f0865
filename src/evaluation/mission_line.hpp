#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vigia/evaluation/campaign.hpp"
#include "vigia/evaluation/drive_score.hpp"

namespace vigia::evaluation {

/// A finished mission as journals and shards keep it: a checked line of JSON.
struct FinishedMission {
  CampaignTask task;
  DriveScore score;
};

std::string mission_line(const CampaignTask& task, const DriveScore& score);
/// Nothing when the line (without its line feed) is not whole.
std::optional<FinishedMission> read_mission_line(std::string_view line);

}  // namespace vigia::evaluation
