#include "mission_line.hpp"

#include "checked_line.hpp"
#include "score_json.hpp"

#include <fmt/format.h>

namespace vigia::evaluation {

std::string mission_line(const CampaignTask& task, const DriveScore& score) {
  return checked_line(fmt::format("{{\"arm\":{},\"score\":{}}}", task.arm, score_record(score)));
}

std::optional<FinishedMission> read_mission_line(std::string_view line) {
  const auto object = unchecked(line);
  if (!object) return std::nullopt;
  const Json json = Json::parse(*object);
  if (!json.contains("score")) return std::nullopt;
  DriveScore score = score_from_json(json.at("score"));
  const CampaignTask task{json.at("arm").get<std::size_t>(), score.seed};
  return FinishedMission{task, std::move(score)};
}

}  // namespace vigia::evaluation
